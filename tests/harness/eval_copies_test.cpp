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

class EvalCopies : public test::RecordedFiles {
 protected:
  /// The reference and ten equal runs of either system.
  std::vector<std::string> ten_copies() const {
    for (int run = 0; run < 10; ++run) {
      write_run("copies/good", "office", run, 0.01);
      write_run("copies/bad", "office", run, 0.03);
    }
    return files_of("office", "copies");
  }
};

TEST_F(EvalCopies, TenCopiesAreOneObservation) {
  const std::vector<std::string> files = ten_copies();
  EXPECT_THAT(test::eval(files), HasSubstr("but 1 sequence cannot show a difference"));
  const std::string out = stored(files);
  EXPECT_THAT(out, HasSubstr("but 1 sequence cannot show a difference"));
  EXPECT_THAT(out, HasSubstr("9 runs repeat the data of another and are not counted"));
  EXPECT_EQ(compared("store").copies, 9u);
}

TEST_F(EvalCopies, CopiesUnderOtherNamesOfTheSequenceAreOneObservation) {
  std::ofstream(path("truths/copy.txt")) << "# another name and a comment\n"
                                         << std::ifstream(path("truths/office.txt")).rdbuf();
  const std::string good = write("good/0.txt", path_of(0.01));
  const std::string bad = write("bad/0.txt", path_of(0.03));
  for (int copy = 1; copy <= 10; ++copy) {
    const std::string reference = path(copy % 2 == 0 ? "truths/office.txt" : "truths/copy.txt");
    stored({reference, good, bad, "--sequence", "c" + std::to_string(copy)});
  }
  const Comparison comparison = compared("store");
  EXPECT_EQ(comparison.copies, 9u);
  EXPECT_EQ(comparison.groups, 1u);
}

TEST_F(EvalCopies, SequencesWithOneReferenceAreOneGroup) {
  for (int copy = 0; copy < 10; ++copy) {  // ten different estimates, each run 0
    const std::string name = "c" + std::to_string(copy);
    stored({path("truths/office.txt"),
            write(name + "/good/0.txt", path_of(0.01 + 0.001 * copy)),
            write(name + "/bad/0.txt", path_of(0.03 + 0.002 * copy)),
            "--sequence",
            name});
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
    const double error = 0.001 * name.front();  // other estimates for each sequence
    std::vector<std::string> arguments{write("truths/" + name + ".txt", reference),
                                       write(name + "/good/0.txt", path_of(0.1 * error)),
                                       write(name + "/bad/0.txt", path_of(0.3 * error))};
    if (has_group) arguments.push_back("--group=own");
    stored(arguments);
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
  const auto add = [&](const std::string& method) {
    stored(test::with(files_of("office", "systems", {method}), {"--sequence", "office"}));
    std::set<std::string> contents;
    for (const Record& r : read_records(path("store"))) contents.insert(r.cell->content);
    return contents.size();
  };
  EXPECT_EQ(add("good"), 1u);  // deterministic: ten equal files
  EXPECT_EQ(add("bad"), 10u);  // its ten runs differ
  EXPECT_EQ(compared("store").groups, 10u);
}

TEST_F(EvalCopies, FailuresOnCopiesAreOneObservation) {
  const std::vector<std::string> files = ten_copies();
  for (int run = 1; run < 10; ++run) {
    std::ofstream(path("copies/bad/office/" + std::to_string(run) + ".txt")) << "1 2 3\n";
  }
  const std::string expected = "8 runs repeat the data of another";
  EXPECT_THAT(test::eval(files, kExitSomeCellsFailed), HasSubstr(expected));
  EXPECT_THAT(stored(files, kExitSomeCellsFailed), HasSubstr(expected));
}

TEST_F(EvalCopies, RunsOfOneSystemAloneAreRunsOfTheSequence) {
  EXPECT_THAT(test::eval(office({"good/office/0", "good/office/1", "bad/office/0"})),
              HasSubstr("but 2 runs of 1 sequence cannot show a difference"));
}

/// Ten runs of two systems on one sequence: the same under any numbers of the files.
TEST_F(EvalCopies, NumbersOfIndependentRunsDoNotMatter) {
  const auto verdict_with = [&](int shift) {
    std::vector<std::string> arguments{path("truths/office.txt")};
    for (int run = 0; run < 10; ++run) {
      const std::string name = "a" + std::to_string(shift) + "/bad";
      arguments.push_back(write(name + "/office/" + std::to_string((run * 3 + shift) % 10) + ".txt",
                                path_of(0.02 + 0.001 * run)));
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
