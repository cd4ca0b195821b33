/// Output of `eval` when metrics are undefined or fail, and when estimates cannot be evaluated.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_failures_test {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr const char* kShort = "0 0 0 0 0 0 0 1\n0.1 0.1 0 0 0 0 0 1\n0.2 0 0.1 0 0 0 0 1\n";

struct EvalFailures : testing::Test {
  const TemporaryFolder folder;
  const std::string file = folder.file("short.txt", kShort).string();
};

TEST_F(EvalFailures, AnUndefinedMetricSaysWhyAndTheOthersStand) {
  const Json results = eval_json({file, file});
  EXPECT_EQ(find(results, "ate", "translation")["count"], 3);
  ASSERT_EQ(results["undefined"].size(), 3u);  // rpe over 1 frame, 1 s and 1 m
  EXPECT_EQ(results["undefined"][0]["why"],
            "found 2 pairs 1.0 frames apart among 3 poses, fewer than min_pairs = 10");
  EXPECT_EQ(results["undefined"][1]["why"], "none of 3 poses is 1.0 s before another");
  EXPECT_THAT(eval({file, file, "--full"}), HasSubstr("\nrpe 1 m undefined: none of 3"));
}

// If pairs 1 m apart are selected on the estimate and there are none, the estimate is at fault and
// not the data, as in sweeps.
TEST_F(EvalFailures, AFailedMetricIsNotUndefinedAndTheOthersStand) {
  const std::string why = "none of 3 poses is 1.0 m before another";
  const std::string from_estimate = "--set=pairs_from=estimate";
  const Json evaluated = eval_json({file, file, from_estimate});
  EXPECT_EQ(evaluated["status"], "ok");
  EXPECT_EQ(evaluated["undefined"].size(), 2u);  // rpe over 1 frame and 1 s
  ASSERT_EQ(evaluated["failed"].size(), 1u);
  EXPECT_EQ(evaluated["failed"][0]["metric"], "rpe");
  EXPECT_EQ(evaluated["failed"][0]["why"], why);
  EXPECT_THAT(eval({file, file, from_estimate, "--full"}), HasSubstr("\nrpe 1 m failed: " + why));
  EXPECT_THAT(eval({file, file, from_estimate, "--csv"}), HasSubstr(",failed," + why + "\n"));

  const Json alone =
      eval_json({file, file, from_estimate, "-d", "1", "-u", "m"}, kExitSomeCellsFailed);
  EXPECT_EQ(alone["status"], "failed");
  EXPECT_EQ(alone["why"], why);
}

TEST_F(EvalFailures, OneBadEstimateIsARowAndTheOthersStand) {
  const std::string bad = folder.file("bad.txt", "1 0 0 \x1b[31m 0 0 0 1\n").string();
  const std::string why = bad + ":1: column 4 (tz): '\x1b[31m' is not a number";
  const std::vector<std::string> files{golden("gt.txt"), bad, golden("est_corrected.txt")};
  EXPECT_EQ(refusal<InputError>({golden("gt.txt"), bad}), why);  // a single estimate is an error

  const Json results = eval_json(files, kExitSomeCellsFailed);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["status"], "failed");
  EXPECT_EQ(results[0]["why"], why);
  EXPECT_TRUE(results[0]["metrics"].empty());
  EXPECT_FALSE(results[0].contains("pairs"));
  EXPECT_EQ(results[1]["status"], "ok");
  EXPECT_EQ(results[1]["pairs"], 635);

  const std::string csv = eval(with(files, {"--csv"}), kExitSomeCellsFailed);
  EXPECT_THAT(csv, HasSubstr("\ngolden,0,bad,"));
  EXPECT_THAT(csv,
              HasSubstr(",failed," + bad + ":1: column 4 (tz): '\\x1b[31m' is not a number\n"));

  const std::string text = eval(files, kExitSomeCellsFailed);
  EXPECT_THAT(text, HasSubstr("failed |"));
  EXPECT_THAT(text, HasSubstr("| est_corrected.txt |"));
  EXPECT_THAT(text,
              HasSubstr("\n- bad.txt: failed: " + bad +
                        ":1: column 4 (tz): ' [31m' is not"));  // no terminal escape sequences
  const std::string three =
      eval({files[0], bad, files[2], golden("est_drift.txt")}, kExitSomeCellsFailed);
  EXPECT_THAT(three, HasSubstr("the baseline est_corrected ranks first: est_drift is"));
}

TEST_F(EvalFailures, AProtocolThatDoesNotFitIsARowAndABadReferenceAnError) {
  const std::vector<std::string> both = drift({"--protocol=tum,kitti"});
  const Json results = eval_json(both, kExitSomeCellsFailed);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["status"], "ok");
  EXPECT_EQ(results[1]["status"], "failed");
  EXPECT_EQ(results[1]["protocol"]["name"], "kitti");
  EXPECT_THAT(eval(both, kExitSomeCellsFailed), HasSubstr("\n- est_drift.txt: failed: "));
  EXPECT_EQ(refusal<InputError>({golden("absent.txt"), golden("gt.txt"), golden("gt.txt")}),
            golden("absent.txt") + ": no such file");
}

TEST_F(EvalFailures, NothingThatWasAskedForIsNoSuccess) {
  const Json results = eval_json(drift({"-d", "1e9"}), kExitSomeCellsFailed);
  EXPECT_EQ(results["status"], "undefined");
  EXPECT_EQ(results["why"], "none of the requested metrics is defined");
  EXPECT_TRUE(results["metrics"].empty());
  EXPECT_EQ(results["undefined"][0]["why"], "none of 635 poses is 1e+09 frames before another");
  const std::string text = eval(drift({"-d", "1e9"}), kExitSomeCellsFailed);
  EXPECT_THAT(text, HasSubstr(" undefined: none of 635 poses"));
}

}  // namespace
}  // namespace loopbench::eval_failures_test
