/// Results of evo for public KITTI estimates; needs the data, which is not in the repository.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "datasets/formats/text_formats.hpp"
#include "metrics/errors/printed_motion.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::kitti_evo_test {

using namespace metrics;

namespace {

/// RPE over 10 m of path, consecutive pairs, with printed matrices or with rotations from them.
Statistics over_ten_metres(const std::filesystem::path& reference,
                           const std::filesystem::path& estimate,
                           bool with_digits) {
  const PrintedPoses printed{read_kitti_matrices(reference), read_kitti_matrices(estimate)};
  const Trajectory truth = read_trajectory(reference), poses = read_trajectory(estimate);
  Evaluation evaluation = evaluate(truth, poses, named_protocol("evo").rules);
  evaluation.context.reference = &truth;
  evaluation.context.estimate = &poses;
  if (with_digits) evaluation.context.printed = &printed;
  EXPECT_EQ(printed_for_evo(evaluation).has_value(), with_digits);
  return find(rpe(evaluation, {.delta = 10.0, .unit = DeltaUnit::m}), "translation", "3d");
}

/// kitti/00 in the data folder; empty without data.
std::filesystem::path kitti_00() {
  const char* data = std::getenv("LOOPBENCH_DATA");
  if (data == nullptr) return {};
  const std::filesystem::path folder = std::filesystem::path(data) / "kitti/00";
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}

TEST(EvoOnKitti, TakesTheDigitsOfTheFiles) {
  const std::filesystem::path folder = kitti_00();
  if (folder.empty()) GTEST_SKIP() << "$LOOPBENCH_DATA names no folder with kitti/00";
  const auto truth = folder / "gt_poses.txt", sptam = folder / "sptam_stereo_open.txt";
  const Statistics exact = over_ten_metres(truth, sptam, true);
  EXPECT_EQ(exact.count, 355u);
  EXPECT_NEAR(exact.rmse, 0.27607109043606004, 1e-12);
  EXPECT_GT(std::abs(over_ten_metres(truth, sptam, false).rmse - exact.rmse), 1e-8);
}

TEST(EvoOnKitti, OrbSlamOverTenMetres) {
  const std::filesystem::path folder = kitti_00();
  if (folder.empty()) GTEST_SKIP() << "$LOOPBENCH_DATA names no folder with kitti/00";
  const Statistics ours =
      over_ten_metres(folder / "gt_poses.txt", folder / "orbslam2_stereo.txt", true);
  EXPECT_EQ(ours.count, 353u);
  EXPECT_NEAR(ours.rmse, 0.22895413855, 1e-11);
}

TEST(EvoOnKitti, OtherPairsThanPoseByPoseHaveNoDigits) {
  const std::string golden = std::string(LOOPBENCH_TEST_DATA) + "/golden/";
  const PrintedPoses printed{read_kitti_matrices(golden + "kitti_gt.txt"),
                             read_kitti_matrices(golden + "kitti_est.txt")};
  const Trajectory truth = read_trajectory(golden + "kitti_gt.txt");
  const Trajectory poses = read_trajectory(golden + "kitti_est.txt");
  const auto uses_digits = [&](const NamedProtocol& protocol) {
    Evaluation evaluation = evaluate(truth, poses, protocol.rules);
    evaluation.context.reference = &truth;
    evaluation.context.estimate = &poses;
    evaluation.context.printed = &printed;
    return printed_for_evo(evaluation).has_value();
  };
  EXPECT_TRUE(uses_digits(named_protocol("evo")));
  EXPECT_TRUE(uses_digits(named_protocol("evo", {{"align", std::string("sim3")}})));
  EXPECT_FALSE(uses_digits(named_protocol("evo", {{"offset", 0.1}})));
  EXPECT_FALSE(uses_digits(named_protocol("evo", {{"project", std::string("xy")}})));
  EXPECT_FALSE(uses_digits(named_protocol("loopbench")));
}

}  // namespace
}  // namespace loopbench::test::kitti_evo_test
