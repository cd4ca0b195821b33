// Methods and runs by the names of recorded files.
#include "harness/commands/eval/evaluated_runs.hpp"

#include <gtest/gtest.h>

#include "harness/commands/eval/evaluated_sweep.hpp"

namespace loopbench::evaluated_runs_test {
namespace {

using namespace harness;

TEST(EvaluatedRuns, NamesGiveMethodAndRun) {
  const auto label = [](const std::string& reference, const std::string& estimate) {
    const EvaluatedRun run = evaluated_runs(reference, {estimate}, "")[0];
    return run.sequence + "|" + run.method + "|" + run.run;
  };
  EXPECT_EQ(label("t/V102.csv", "vislam/V102/7.txt"), "V102|vislam|7");
  EXPECT_EQ(label("fr1_room/groundtruth.txt", "x/orb_run1.txt"), "fr1_room|orb|1");
  EXPECT_EQ(label("t/a.txt", "x/orb-3.txt"), "a|orb|3");
  EXPECT_EQ(label("t/a.txt", "orb/12.txt"), "a|orb|12");
  EXPECT_EQ(label("t/a.txt", "x/orbslam2.txt"), "a|orbslam2|0");
  EXPECT_EQ(label("bag:b.bag#groundtruth", "bag:b.bag#/odom"), "b|odom|0");
}

TEST(EvaluatedRuns, FoldersOfASequenceAreNotMethods) {
  const auto methods = [](const std::string& reference, const std::string& sequence) {
    std::vector<std::string> out;
    for (const EvaluatedRun& run : evaluated_runs(
             reference, {"est/A/seq1/0.txt", "est/A/seq1/1.txt", "est/B/seq1/0.txt"}, sequence)) {
      out.push_back(run.method);
    }
    return out;
  };
  const std::vector<std::string> expected{"A", "A", "B"};
  EXPECT_EQ(methods("lay/groundtruth.txt", "seq1"), expected);
  EXPECT_EQ(methods("lay/groundtruth.txt", ""), expected);
  EXPECT_EQ(methods("seq1/groundtruth.txt", ""), expected);
  // One file for each method, next to the reference or in a folder of results.
  EXPECT_EQ(evaluated_runs("s/groundtruth.txt", {"s/orb.txt"}, "")[0].method, "orb");
  EXPECT_EQ(evaluated_runs("s/groundtruth.txt", {"out/s/orb.txt"}, "")[0].method, "orb");
  EXPECT_EQ(evaluated_runs("s/groundtruth.txt", {"s/0.txt"}, "")[0].method, "s");
}

TEST(EvaluatedRuns, OneFileIsNotTwoMethods) {
  EXPECT_THROW(evaluated_runs("t/a.txt", {"one/odom.txt", "one/./odom.txt"}, ""), InputError);
  const auto runs = evaluated_runs("t/a.txt", {"a_1.txt", "a_01.txt"}, "");
  const auto cells = evaluated_sweep(runs, EvalArguments{}).cells;
  EXPECT_NE(cells[0].repeat, cells[1].repeat);
  EXPECT_EQ(evaluated_runs("a.txt", {"bag:b.bag#/odom"}, "")[0].estimate,
            "bag:" + std::filesystem::absolute("b.bag").string() + "#/odom");
}

TEST(EvaluatedRuns, RunsAreOrderedByTheirNumbers) {
  const auto runs = evaluated_runs("t/a.txt", {"x_10.txt", "x_9.txt"}, "");
  EXPECT_EQ(evaluated_sweep(runs, EvalArguments{}).cells.front().dataset, 1u);
}

TEST(EvaluatedRuns, EqualNamesInOtherFoldersAreOtherMethods) {
  const auto runs = evaluated_runs("t/a.txt", {"one/odom.txt", "two/odom.txt"}, "s");
  EXPECT_EQ(runs[0].method, "one/odom");
  EXPECT_EQ(runs[1].method, "two/odom");
  EXPECT_THROW(evaluated_runs("t/a.txt", {"one/odom.txt", "one/odom.txt"}, ""), InputError);
  EXPECT_EQ(runs_of_manifest(evaluated_sweep(runs, EvalArguments{}).sweep.text), runs);
}

}  // namespace
}  // namespace loopbench::evaluated_runs_test
