// `eval --store`: equal runs count once, and equal references are one recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "harness/store/read.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/recorded_files.hpp"

namespace loopbench::eval_copies_test {
namespace {

using testing::HasSubstr;
using namespace harness;

class EvalCopies : public test::RecordedFiles {};

TEST_F(EvalCopies, TenCopiesAreOneObservation) {
  std::vector<std::string> arguments{path("truths/office.txt")};
  for (int run = 0; run < 10; ++run) {
    write_run("copies/good", "office", run, 0.01);
    write_run("copies/bad", "office", run, 0.03);
    for (const char* const method : {"good", "bad"}) {
      arguments.push_back(
          path("copies/" + std::string(method) + "/office/" + std::to_string(run) + ".txt"));
    }
  }
  EXPECT_THAT(test::eval(arguments), HasSubstr("but 1 sequence cannot show a difference"));
  arguments.insert(arguments.end(), {"--store", path("store")});
  const std::string out = test::eval(arguments);
  EXPECT_THAT(out, HasSubstr("but 1 sequence cannot show a difference"));
  EXPECT_THAT(out, HasSubstr("9 runs repeat the data of another and are not counted"));
  EXPECT_EQ(compared("store").copies, 9u);
}

TEST_F(EvalCopies, CopiesUnderOtherNamesOfTheSequenceAreOneObservation) {
  std::ofstream(path("truths/copy.txt")) << "# another name and a comment\n"
                                         << std::ifstream(path("truths/office.txt")).rdbuf();
  for (const char* const method : {"good", "bad"}) {
    std::filesystem::create_directories(path(method));
    write_tum(path(std::string(method) + "/0.txt"), path_of(*method == 'g' ? 0.01 : 0.03));
  }
  for (int copy = 1; copy <= 10; ++copy) {
    test::eval({path(copy % 2 == 0 ? "truths/office.txt" : "truths/copy.txt"),
                path("good/0.txt"),
                path("bad/0.txt"),
                "--sequence",
                "c" + std::to_string(copy),
                "--store",
                path("store")});
  }
  const Comparison comparison = compared("store");
  EXPECT_EQ(comparison.copies, 9u);
  EXPECT_EQ(comparison.groups, 1u);
}

TEST_F(EvalCopies, SequencesWithOneReferenceAreOneGroup) {
  for (int copy = 0; copy < 10; ++copy) {  // ten different estimates, each run 0
    const std::string name = "c" + std::to_string(copy);
    std::filesystem::create_directories(path(name + "/good"));
    std::filesystem::create_directories(path(name + "/bad"));
    write_tum(path(name + "/good/0.txt"), path_of(0.01 + 0.001 * copy));
    write_tum(path(name + "/bad/0.txt"), path_of(0.03 + 0.002 * copy));
    test::eval({path("truths/office.txt"),
                path(name + "/good/0.txt"),
                path(name + "/bad/0.txt"),
                "--sequence",
                name,
                "--store",
                path("store")});
  }
  const Comparison comparison = compared("store");
  EXPECT_EQ(comparison.copies, 0u);
  EXPECT_EQ(comparison.runs, 10u);
  EXPECT_EQ(comparison.groups, 1u);
  EXPECT_FALSE(comparison.is_best);
  EXPECT_THAT(comparison.same_recordings, testing::Contains("c1 of c0"));
}

TEST_F(EvalCopies, AStatedGroupOverrulesTheReference) {
  const auto add = [&](const std::string& name, const Trajectory& reference, bool has_group) {
    write_tum(path("truths/" + name + ".txt"), reference);
    const double error = 0.001 * name.front();  // other estimates for each sequence
    for (const std::string method : {"good", "bad"}) {
      std::filesystem::create_directories(path(name + "/" + method));
      write_tum(path(name + "/" + method + "/0.txt"),
                path_of(method == "good" ? 0.1 * error : 0.3 * error));
    }
    std::vector<std::string> arguments{path("truths/" + name + ".txt"),
                                       path(name + "/good/0.txt"),
                                       path(name + "/bad/0.txt"),
                                       "--store",
                                       path("store")};
    if (has_group) arguments.push_back("--group=own");
    test::eval(arguments);
    return compared("store").groups;
  };
  const Trajectory whole = path_of(0.0);
  const Trajectory cropped(whole.begin(), whole.begin() + 40);
  EXPECT_EQ(add("a", whole, false), 1u);
  EXPECT_EQ(add("b", whole, false), 1u);
  EXPECT_EQ(add("c", whole, true), 2u);
  EXPECT_EQ(add("d", cropped, false), 3u);  // which poses are of one recording, --group states
  EXPECT_EQ(add("e", cropped, true), 3u);
}

TEST_F(EvalCopies, AMethodThatIsAddedLaterSeparatesRunsThatWereEqual) {
  for (int run = 0; run < 10; ++run) write_run("systems/good", "office", run, 0.01);
  const std::vector<std::string> tail{"--sequence", "office", "--store", path("store")};
  const auto add = [&](const std::string& method) {
    std::vector<std::string> arguments{path("truths/office.txt")};
    for (int run = 0; run < 10; ++run) {
      arguments.push_back(path("systems/" + method + "/office/" + std::to_string(run) + ".txt"));
    }
    arguments.insert(arguments.end(), tail.begin(), tail.end());
    test::eval(arguments);
  };
  const auto contents = [&] {
    std::set<std::string> out;
    for (const Record& r : read_records(path("store"))) out.insert(r.content);
    return out.size();
  };
  add("good");  // deterministic: ten equal files
  EXPECT_EQ(contents(), 1u);
  add("bad");  // its ten runs differ
  EXPECT_EQ(contents(), 10u);
  EXPECT_EQ(compared("store").groups, 10u);
}

TEST_F(EvalCopies, FailuresOnCopiesAreOneObservation) {
  std::vector<std::string> arguments{path("truths/office.txt")};
  for (int run = 0; run < 10; ++run) {
    write_run("copies/good", "office", run, 0.01);
    write_run("copies/bad", "office", run, 0.03);
    const std::string number = std::to_string(run);
    if (run > 0) std::ofstream(path("copies/bad/office/" + number + ".txt")) << "1 2 3\n";
    for (const char* const method : {"good", "bad"}) {
      arguments.push_back(path("copies/" + std::string(method) + "/office/" + number + ".txt"));
    }
  }
  const std::string expected = "8 runs repeat the data of another";
  EXPECT_THAT(test::eval(arguments, kExitSomeCellsFailed), HasSubstr(expected));
  arguments.insert(arguments.end(), {"--store", path("store")});
  EXPECT_THAT(test::eval(arguments, kExitSomeCellsFailed), HasSubstr(expected));
}

TEST_F(EvalCopies, RunsOfOneSystemAloneAreRunsOfTheSequence) {
  const std::string out = test::eval({path("truths/office.txt"),
                                      path("systems/good/office/0.txt"),
                                      path("systems/good/office/1.txt"),
                                      path("systems/bad/office/0.txt")});
  EXPECT_THAT(out, HasSubstr("but 2 runs of 1 sequence cannot show a difference"));
}

/// Ten runs of two systems on one sequence: the same under any numbers of the files.
TEST_F(EvalCopies, NumbersOfIndependentRunsDoNotMatter) {
  const auto verdict_with = [&](int shift) {
    std::vector<std::string> arguments{path("truths/office.txt")};
    for (int run = 0; run < 10; ++run) {
      const std::string name = "a" + std::to_string(shift) + "/bad/office";
      std::filesystem::create_directories(path(name));
      const int number = (run * 3 + shift) % 10;
      write_tum(path(name + "/" + std::to_string(number) + ".txt"), path_of(0.02 + 0.001 * run));
      arguments.push_back(path(name + "/" + std::to_string(number) + ".txt"));
      arguments.push_back(path("systems/good/office/" + std::to_string(run) + ".txt"));
    }
    const std::string out = test::eval(arguments);
    return out.substr(out.find("\nverdict: "));
  };
  const std::string first = verdict_with(0);
  EXPECT_THAT(first, HasSubstr("rank sums within it, for more runs of it"));
  EXPECT_EQ(verdict_with(1), first);
  EXPECT_EQ(verdict_with(7), first);
}

}  // namespace
}  // namespace loopbench::eval_copies_test
