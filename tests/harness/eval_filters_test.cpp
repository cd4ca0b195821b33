/// Time ranges, filters and units of `eval`, against evo 1.36 on the same files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/eval_command.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::eval_filters_test {
namespace {

using namespace test;

Json evaluated(const std::vector<std::string>& options, int expected_exit = kExitOk) {
  std::vector<std::string> words{golden("gt.txt"), golden("est_drift.txt"), "--protocol=evo", "-a"};
  words.insert(words.end(), options.begin(), options.end());
  return eval_json(words, expected_exit);
}

double ate(const Json& result, const char* relation = "translation") {
  return find(result, "ate", relation)["rmse"];
}

TEST(EvalFilters, MotionFilterIsThatOfEvo) {
  const Json result = evaluated({"--motion_filter", "0.2", "3"});
  EXPECT_EQ(result["pairs"], 61);  // of 356 poses of the reference
  EXPECT_EQ(result["possible"], 303);
  EXPECT_NEAR(ate(result), 0.6714582585666118, 1e-12);
}

TEST(EvalFilters, TimeRangeCutsTheReference) {
  const Json result = evaluated({"--t_start=1700000010", "--t_end=1700000020"});
  EXPECT_EQ(result["pairs"], 165);
  EXPECT_GT(result["coverage"], 0.95);
  EXPECT_NEAR(ate(result), 0.14221731741268467, 1e-12);
  const std::vector<std::string> files{golden("gt.txt"), golden("gt.txt")};
  EXPECT_EQ(refusal<InputError>({files[0], files[1], "--start=2", "--end=1"}),
            "--start 2 is after --end 1");
  EXPECT_EQ(refusal<InputError>({files[0], files[1], "--end=1"}),
            files[0] + ": has no poses between --start and --end");
}

TEST(EvalFilters, DownsamplesBothFiles) {
  const Json result = evaluated({"-s", "--downsample=300", "--t_max_diff=0.05"});
  EXPECT_EQ(result["pairs"], 227);
  EXPECT_NEAR(ate(result), 0.6610658733288742, 1e-12);
}

TEST(EvalFilters, PairsAreThoseOfEvo) {
  EXPECT_EQ(evaluated({"--t_max_diff=0.003", "--t_offset=-0.004"})["pairs"], 578);
  // A reference pose can be the nearest one of several poses.
  const Json burst = eval_json({golden("gt.txt"), golden("est_burst.txt"), "--association=evo"});
  EXPECT_EQ(burst["pairs"], 953);
}

TEST(EvalFilters, UnitsChange) {
  EXPECT_NEAR(ate(evaluated({"--change_unit=mm"})), 676.208260682124, 1e-9);
  const Json result = evaluated({"--unit=rad", "-r", "angle_deg"});
  const Json& ape = result["metrics"][0];
  EXPECT_EQ(ape["unit"], "rad");
  EXPECT_NEAR(ape["rmse"], 0.11910329954688206, 1e-12);
  const Json degrees = evaluated({"--unit=deg", "-r", "angle_rad"});
  EXPECT_NEAR(degrees["metrics"][0]["rmse"], 0.11910329954688206 * 180.0 / M_PI, 1e-9);
  const std::string runs =
      eval({golden("gt.txt"), golden("est_drift.txt"), golden("est_corrected.txt"), "--unit=km"});
  EXPECT_NE(runs.find("| 0.000676 |"), std::string::npos) << runs;
  EXPECT_EQ(refusal<InputError>({golden("gt.txt"), golden("gt.txt"), "--unit=inch"}),
            "--unit: found 'inch', expected mm, cm, m, km, deg or rad");
  EXPECT_EQ(
      refusal<InputError>({golden("gt.txt"), golden("gt.txt"), "--unit=km", "--metric=coverage"}),
      "--unit km: no score is a length");
}

TEST(EvalFilters, PrintsTheTransformThatTrajReads) {
  const Json alignment = evaluated({"-s"})["alignment"];
  for (const char* key : {"x", "y", "z", "qx", "qy", "qz", "qw", "scale"}) {
    EXPECT_TRUE(alignment[key].is_number()) << key;
  }
  const std::string text = eval({golden("gt.txt"), golden("est_drift.txt")});
  EXPECT_THAT(text, testing::HasSubstr("\ntransform  x,y,z,qx,qy,qz,qw = "));
  EXPECT_THAT(eval({golden("gt.txt"), golden("est_drift.txt"), "--align=none"}),
              testing::Not(testing::HasSubstr("\ntransform ")));
}

}  // namespace
}  // namespace loopbench::eval_filters_test
