// motion_drift on loops that cover only a small part of the chain.
#include <gtest/gtest.h>

#include <cstdlib>

#include "datasets/derive/poses_at.hpp"
#include "datasets/trajectory_dataset.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::motion_drift_short_loops_test {

using namespace methods;

namespace {

const MotionDrift::Options kAverage{.abstain_closures = 0};

using namespace test;

/// A car drives 300 m, rests for ten keyframes and drives on for the same distance, with keyframes
/// every half second, 5 m apart. At rest the odometry has noise of a centimetre and a milliradian,
/// and a closure with ordinary noise joins the first and last keyframe of the rest.
Problem with_a_stop() {
  Problem out;
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << Vector3::Constant(1e4), Vector3::Constant(4e4);
  out.keyframes.push_back({0.0, {}});
  for (std::size_t i = 0; i < 130; ++i) {
    const bool is_at_rest = i >= 60 && i < 70;
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    const Pose step = is_at_rest ? Pose{exp_so3({0.0, 0.0, 0.001 * sign}), {0.01 * sign, 0.0, 0.0}}
                                 : Pose{exp_so3({0.0, 0.0, 0.02}), {5.0, 0.0, 0.0}};
    out.odometry.push_back({i, i + 1, step, information});
    out.keyframes.push_back({0.5 * static_cast<double>(i + 1),
                             normalized(out.keyframes.back().world_from_body * step)});
  }
  const Pose gap{exp_so3({0.004, -0.003, 0.005}), {0.03, -0.02, 0.04}};
  information.diagonal() << Vector3::Constant(2500.0), Vector3::Constant(1e4);
  out.closures.push_back({60, 70, gap, information});
  return out;
}

TEST(MotionDriftShortLoops, ALoopAtRestDoesNotDeformTheTrajectory) {
  const Problem problem = with_a_stop();
  Report report;
  const Trajectory out = MotionDrift(kAverage).correct(problem, report);
  // 7 mrad over 300 m are 2 m; before the fix, all keyframes moved by tens of metres.
  EXPECT_LT(largest_distance(out, problem.keyframes), 3.0);
  EXPECT_TRUE(report.notes.empty());
}

TEST(MotionDriftShortLoops, AStopOnKitti05AddsNoError) {
  const char* root = std::getenv("LOOPBENCH_DATA");
  if (root == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  TrajectoryOptions options;
  options.estimate = "kitti/05/kiss_icp_open.txt";
  options.reference = "kitti/05/gt_poses.txt";
  options.keyframes = {KeyframeRule::every, 5};
  try {
    Sequence sequence = load_trajectory(options, {{root}});
    Problem& problem = sequence.problem;
    const auto truth = poses_at(sequence.reference, stamps(problem.keyframes), {});
    Matrix6 information = Matrix6::Zero();
    information.diagonal() << Vector3::Constant(2500.0), Vector3::Constant(1e4);
    const Pose exact = normalized(truth[465]->inverse() * *truth[475]);
    problem.closures = {{465, 475, exact, information}};
    // before the fix: tens of metres
    EXPECT_LT(largest_distance(corrected<MotionDrift>(problem, kAverage), problem.keyframes), 1.0);
  } catch (const DataMissing& missing) {
    GTEST_SKIP() << missing.what();
  }
}

TEST(MotionDriftShortLoops, DriftReachIsAMultipleOfTheLoopLength) {
  Problem problem = with_a_stop();
  problem.closures.front().from = 20;
  problem.closures.front().to = 40;
  std::vector<EdgeMotion> moved = motions(problem);
  limit_drift(moved, problem, 0.525);
  const auto part = [&](Regressor regressor, std::size_t edge) {
    return moved[edge].drift_part[static_cast<std::size_t>(regressor)];
  };
  // Twenty edges of 0.5 s and 5 m inside the loop, ten and a half beyond either end.
  for (const Regressor regressor :
       {Regressor::edge, Regressor::time, Regressor::distance, Regressor::rotation}) {
    EXPECT_EQ(part(regressor, 8), 0.0);
    EXPECT_NEAR(part(regressor, 9), 0.5, 1e-9);
    EXPECT_EQ(part(regressor, 10), 1.0);
    EXPECT_EQ(part(regressor, 30), 1.0);
    EXPECT_EQ(part(regressor, 49), 1.0);
    EXPECT_NEAR(part(regressor, 50), 0.5, 1e-9);
    EXPECT_EQ(part(regressor, 51), 0.0);
  }
}

TEST(MotionDriftShortLoops, ALoopAtRestHasNoReachInDistance) {
  const Problem problem = with_a_stop();
  std::vector<EdgeMotion> moved = motions(problem);
  limit_drift(moved, problem, 1.0);
  const auto by_distance = static_cast<std::size_t>(Regressor::distance);
  EXPECT_EQ(moved[65].drift_part[by_distance], 1.0);
  EXPECT_NEAR(moved[70].drift_part[by_distance], 0.1 / 5.0, 1e-9);  // ten edges of one centimetre
  EXPECT_EQ(moved[71].drift_part[by_distance], 0.0);
}

TEST(MotionDriftShortLoops, ALargeMoveIsReported) {
  const Problem problem = with_a_stop();
  MotionDrift::Options steady{.fit = false};
  steady.drift[1][1] = 0.01;  // [rad/s]
  steady.prior.drift_reach = 1e9;
  Report report;
  const Trajectory out = MotionDrift(steady).correct(problem, report);
  ASSERT_GT(largest_distance(out, problem.keyframes), 10.0);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("extrapolated far beyond the loops"), std::string::npos)
      << report.notes[0];
}

TEST(MotionDriftShortLoops, AGapExplainsItsLengthAndItsAngleTimesTheLeverArm) {
  const Problem problem = circle();  // diameter 10 m, closed from first to last keyframe
  Report report;
  const Trajectory out = corrected<MotionDrift>(problem, kAverage, &report);
  EXPECT_NEAR(count(report, "largest_move"), largest_distance(out, problem.keyframes), 1e-12);
  const Eigen::VectorXd gap = LoopedChain(problem, stated_noise_model(problem)).linearise().gap;
  double farthest = 0.0;
  for (const StampedPose& k : problem.keyframes) {
    farthest = std::max(
        farthest,
        (k.world_from_body.translation - problem.keyframes.back().world_from_body.translation)
            .norm());
  }
  EXPECT_NEAR(count(report, "explained_move"),
              gap.head<3>().norm() + farthest * gap.tail<3>().norm(),
              1e-12);
}

}  // namespace
}  // namespace loopbench::motion_drift_short_loops_test
