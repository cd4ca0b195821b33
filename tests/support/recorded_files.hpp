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

  /// Writes a file, and its folder if there is none; its path.
  std::string write(const std::string& name, const Trajectory& poses) const {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    write_tum(folder_.path() / name, poses);
    return path(name);
  }

  std::string write_run(const std::string& method,
                        const std::string& sequence,
                        int run,
                        double error) const {
    return write(method + "/" + sequence + "/" + std::to_string(run) + ".txt",
                 path_of(error, start_of(sequence)));
  }

  /// The reference of a sequence and all runs of systems in a folder, for `eval`.
  std::vector<std::string> files_of(const std::string& sequence,
                                    const std::string& systems = "systems",
                                    const std::vector<std::string>& methods = {"bad",
                                                                               "good"}) const {
    std::vector<std::string> out{path("truths/" + sequence + ".txt")};
    for (const std::string& method : methods) {
      for (int run = 0; run < 10; ++run) {
        const std::string name = systems + "/" + method + "/" + sequence + "/";
        out.push_back(path(name + std::to_string(run) + ".txt"));
      }
    }
    return out;
  }

  /// Output of `eval` of the files into a store.
  std::string stored(const std::vector<std::string>& files,
                     int expected_exit = kExitOk,
                     const std::string& store = "store") const {
    return eval(with(files, {"--store", path(store)}), expected_exit);
  }

  /// The reference of office and runs of systems on it, for example "bad/office/0".
  std::vector<std::string> office(const std::vector<std::string>& runs) const {
    std::vector<std::string> out{path("truths/office.txt")};
    for (const std::string& run : runs) out.push_back(path("systems/" + run + ".txt"));
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
      out = stored(with(files_of(sequence, systems), options), expected_exit, store);
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
    for (const std::string sequence : {"office", "street"}) {
      write("truths/" + sequence + ".txt", path_of(0.0, start_of(sequence)));
      for (int run = 0; run < 10; ++run) {
        write_run("systems/good", sequence, run, 0.01 + 0.0005 * run);
        write_run("systems/bad", sequence, run, 0.03 + 0.0013 * run);
      }
    }
  }

  TemporaryFolder folder_;
};

}  // namespace loopbench::test
