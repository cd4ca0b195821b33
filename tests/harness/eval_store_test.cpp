// `eval --store`: statistics over the runs of systems, as a store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "harness/eval/recorded_runs.hpp"
#include "harness/eval/recorded_sweep.hpp"
#include "harness/store/read.hpp"
#include "tests/support/eval_command.hpp"
#include "tests/support/recorded_files.hpp"

namespace loopbench::eval_store_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using namespace harness;

class EvalStore : public test::RecordedFiles {};

TEST_F(EvalStore, RunsAreRepeatsAndSystemsAreMethods) {
  const std::string out = test::eval({path("truths"), path("systems"), "--store", path("store")});
  EXPECT_THAT(out, HasSubstr("40 runs in"));
  EXPECT_THAT(out, ContainsRegex("\n\\| office / bad +\\| +10 of 10 \\|"));
  EXPECT_THAT(out, HasSubstr("good is"));  // the verdict
  EXPECT_THAT(out, HasSubstr("20 runs"));
  const auto cells = read_cells(path("store"));
  ASSERT_EQ(cells.size(), 40u);
  EXPECT_EQ(cells.back().repeat, 9);
  CompareOptions options;
  const auto comparison = compare_store(path("store"), "ate", {"unit=m"}, options);
  ASSERT_EQ(comparison.size(), 1u);
  EXPECT_EQ(comparison[0].groups, 20u);
  EXPECT_TRUE(comparison[0].is_best_proven);
  EXPECT_EQ(comparison[0].methods[0].method, "good");
}

TEST_F(EvalStore, NumbersAreThoseOfEval) {
  test::eval({path("truths"), path("systems"), "--store", path("store")});
  const std::string estimate = path("systems/bad/office/3.txt");
  const test::Json json = test::eval_json({path("truths/office.txt"), estimate});
  const double expected = test::find(json, "ate", "translation")["rmse"];
  for (const Record& r : read_records(path("store"))) {
    if (r.sequence == "office" && r.method == "bad" && r.repeat == 3 && r.label == "ate" &&
        r.relation == "translation" && r.axis == "3d") {
      EXPECT_DOUBLE_EQ(r.statistics.rmse, expected);
      return;
    }
  }
  FAIL() << "no such record";
}

TEST_F(EvalStore, LaterCallsAddRunsAndKeepTheOthers) {
  test::eval({path("truths/office.txt"), path("systems/good/office/0.txt"), "--store", path("s")});
  EXPECT_THAT(test::eval({path("truths/office.txt"),
                          path("systems/bad/office/0.txt"),
                          path("systems/bad/office/1.txt"),
                          "--store",
                          path("s")}),
              HasSubstr("3 runs in"));
  EXPECT_EQ(read_cells(path("s")).size(), 3u);
  EXPECT_THAT(
      test::eval(
          {path("truths/office.txt"), path("systems/bad/office/1.txt"), "--store", path("s")}),
      HasSubstr("(3 stored before)"));
  write_run("systems/bad", "office", 1, 0.5);  // changed: evaluated again
  EXPECT_THAT(
      test::eval(
          {path("truths/office.txt"), path("systems/bad/office/1.txt"), "--store", path("s")}),
      HasSubstr("(2 stored before)"));
}

TEST_F(EvalStore, ARunThatCannotBeReadIsAFailure) {
  std::ofstream(path("systems/bad/office/3.txt")) << "1 2 3\n";
  const std::string out =
      test::eval({path("truths"), path("systems"), "--store", path("store")}, kExitSomeCellsFailed);
  EXPECT_THAT(out, ContainsRegex("\n\\| office / bad +\\| +9 of 10 \\|"));
  EXPECT_THAT(out, HasSubstr("1 failed"));
}

TEST_F(EvalStore, ARepairedFileIsEvaluatedAgain) {
  const std::string broken = path("systems/bad/office/3.txt");
  std::ofstream(broken) << "1 2 3\n";
  const std::vector<std::string> arguments{path("truths"), path("systems"), "--store", path("s")};
  EXPECT_THAT(test::eval(arguments, kExitSomeCellsFailed),
              HasSubstr("1 failed\nfailed: " + broken));
  EXPECT_THAT(test::eval(arguments, kExitSomeCellsFailed),
              HasSubstr("1 failed\nfailed: " + broken));
  write_run("systems/bad", "office", 3, 0.034);
  const std::string out = test::eval(arguments);
  EXPECT_THAT(out, HasSubstr("(39 stored before)"));
  EXPECT_THAT(out, ContainsRegex("\n\\| office / bad +\\| +10 of 10 \\|"));
}

TEST_F(EvalStore, EvalOfSeveralEstimatesEndsWithTheVerdict) {
  std::vector<std::string> arguments{path("truths/office.txt")};
  for (int run = 0; run < 10; ++run) {
    for (const char* const method : {"good", "bad"}) {
      arguments.push_back(
          path("systems/" + std::string(method) + "/office/" + std::to_string(run) + ".txt"));
    }
  }
  EXPECT_THAT(test::eval(arguments), HasSubstr("verdict on ate: "));
}

TEST(RecordedRuns, NamesGiveMethodAndRun) {
  const auto label = [](const std::string& reference, const std::string& estimate) {
    const RecordedRun run = recorded_runs({{reference, estimate}}, "")[0];
    return run.sequence + "|" + run.method + "|" + run.run;
  };
  EXPECT_EQ(label("t/V102.csv", "vislam/V102/7.txt"), "V102|vislam|7");
  EXPECT_EQ(label("fr1_room/groundtruth.txt", "x/orb_run1.txt"), "fr1_room|orb|1");
  EXPECT_EQ(label("t/a.txt", "x/orb-3.txt"), "a|orb|3");
  EXPECT_EQ(label("t/a.txt", "orb/12.txt"), "a|orb|12");
  EXPECT_EQ(label("t/a.txt", "x/orbslam2.txt"), "a|orbslam2|0");
  EXPECT_EQ(label("bag:b.bag#groundtruth", "bag:b.bag#/odom"), "b|odom|0");
  EXPECT_TRUE(natural_less("run9", "run10"));
  EXPECT_FALSE(natural_less("run10", "run9"));
}

TEST(RecordedRuns, EqualNamesInOtherFoldersAreOtherMethods) {
  const auto runs = recorded_runs({{"t/a.txt", "one/odom.txt"}, {"t/a.txt", "two/odom.txt"}}, "s");
  EXPECT_EQ(runs[0].method, "one/odom");
  EXPECT_EQ(runs[1].method, "two/odom");
  EXPECT_THROW(recorded_runs({{"t/a.txt", "one/odom.txt"}, {"t/a.txt", "one/odom.txt"}}, ""),
               InputError);
  EXPECT_EQ(runs_of_manifest(manifest(runs)), runs);
}

TEST(RecordedRuns, RealRunsOfTwoSystems) {
  const char* const data = std::getenv("LOOPBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "needs LOOPBENCH_DATA";
  const TemporaryFolder folder;
  const std::string root = std::string(data) + "/euroc_repeats";
  std::vector<std::string> arguments{root + "/truth/V201.csv"};
  for (int run = 0; run < 10; ++run) {
    for (const char* const method : {"vislam_ba", "vislam_rp"}) {
      arguments.push_back(root + "/" + method + "/V201/" + std::to_string(run) + ".txt");
    }
  }
  arguments.insert(arguments.end(), {"--store", (folder.path() / "s").string()});
  const std::string out = test::eval(arguments);
  EXPECT_THAT(out, ContainsRegex("\n\\| V201 / vislam_ba +\\| +10 of 10 \\|"));
  EXPECT_THAT(out, HasSubstr("verdict on ate: "));
}

}  // namespace
}  // namespace loopbench::eval_store_test
