/// Files of two systems on two sequences, for tests of `eval --store`.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "datasets/formats/formats.hpp"
#include "harness/tables/all_records.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::test {

using namespace harness;

/// METHOD/SEQUENCE/RUN.txt with an error of `size` times the run, and truths/SEQUENCE.txt.
class RecordedFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  static Trajectory path_of(double error, double start = 0.0) {
    Trajectory out;
    for (int i = 0; i < 60; ++i) {
      const double a = start + 0.1 * i;
      const double e = error * std::sin(7.0 * a);
      const double climb = 0.2 + 0.6 * start;  // other starts have another path
      out.push_back(
          {a, {exp_so3({0, 0, a}), {3 * std::cos(a) + e, 3 * std::sin(a), climb * a + e}}});
    }
    return out;
  }

  /// The sequences have different paths, because equal ones would be one recording.
  static double start_of(const std::string& sequence) { return sequence == "office" ? 0.0 : 1.0; }

  void write_run(const std::string& method, const std::string& sequence, int run, double error) {
    const std::filesystem::path folder = folder_.path() / method / sequence;
    std::filesystem::create_directories(folder);
    write_tum(folder / (std::to_string(run) + ".txt"), path_of(error, start_of(sequence)));
  }

  /// The reference of a sequence and all runs of both systems in a folder, for `eval`.
  std::vector<std::string> files_of(const std::string& sequence,
                                    const std::string& systems = "systems") const {
    std::vector<std::string> out{path("truths/" + sequence + ".txt")};
    for (const std::string method : {"bad", "good"}) {
      for (int run = 0; run < 10; ++run) {
        const std::string name = systems + "/" + method + "/" + sequence + "/";
        out.push_back(path(name + std::to_string(run) + ".txt"));
      }
    }
    return out;
  }

  /// Evaluates both systems of a folder into a store, a call for each sequence, with more options;
  /// the output of the last call.
  std::string store_systems(const std::string& store,
                            const std::vector<std::string>& options = {},
                            int expected_exit = kExitOk,
                            const std::string& systems = "systems") const {
    std::string out;
    for (const char* const sequence : {"office", "street"}) {
      std::vector<std::string> arguments = files_of(sequence, systems);
      arguments.insert(arguments.end(), {"--store", path(store)});
      arguments.insert(arguments.end(), options.begin(), options.end());
      out = eval(arguments, expected_exit);
    }
    return out;
  }

  /// The comparison of a store by translational ATE.
  Comparison compared(const std::string& store) const {
    CompareOptions options;
    const auto all = compare_store(path(store), "ate", {"unit=m"}, options);
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? Comparison{} : all.front();
  }

  /// 20 s with varied speed, in which the doctor can measure offsets.
  static Trajectory long_path(double error) {
    Trajectory out;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.05 * i;
      const double e = error * std::sin(3.0 * t);
      out.push_back({t + 1000.0,
                     {exp_so3({0, 0, 0.6 * t}) * exp_so3({0.5 * std::sin(0.9 * t), 0, 0}),
                      {4 * std::cos(0.6 * t + 0.2 * std::sin(t)) + e,
                       3 * std::sin(0.6 * t),
                       std::sin(0.35 * t)}}});
    }
    return out;
  }

  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "truths");
    for (const char* const sequence : {"office", "street"}) {
      write_tum(folder_.path() / "truths" / (std::string(sequence) + ".txt"),
                path_of(0.0, start_of(sequence)));
      for (int run = 0; run < 10; ++run) {
        write_run("systems/good", sequence, run, 0.01 + 0.0005 * run);
        write_run("systems/bad", sequence, run, 0.03 + 0.0013 * run);
      }
    }
  }

  TemporaryFolder folder_;
};

}  // namespace loopbench::test
