#include "methods/correctors/scale_drift.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::scale_drift_test {

using namespace methods;

namespace {

using namespace test;

/// One lap of a square of 40 m in steps of one metre. The scale grows by `creep` per step without
/// being measured by the odometry; the closure from the end to the start measures it.
struct ScaleDrift {
  Trajectory truth;
  Problem problem;
};

/// `precision`: information of the closure [1/m^2], [1/rad^2].
ScaleDrift scale_drift(double creep, double precision) {
  ScaleDrift out;
  Pose pose;
  Pose measured_pose;
  double unit = 1.0;  // current scale; a true metre is one unit at the start
  Matrix6 information = Matrix6::Identity() * 1e4;
  for (std::size_t i = 0; i <= 40; ++i) {
    out.truth.push_back({static_cast<double>(i), pose});
    out.problem.keyframes.push_back({static_cast<double>(i), measured_pose});
    if (i == 40) break;
    const double angle = i % 10 == 9 ? 0.5 * std::numbers::pi : 0.0;
    const Pose step{exp_so3({0, 0, angle}), Vector3(1, 0, 0)};
    const Pose measured{step.rotation, step.translation / unit};
    out.problem.odometry.push_back({i, i + 1, measured, information, 1.0});
    pose = normalized(pose * step);
    measured_pose = normalized(measured_pose * measured);
    unit *= std::exp(creep);
  }
  out.problem.closures.push_back({0, 40, pose, Matrix6::Identity() * precision, unit});
  return out;
}

TEST(ScaleDrift, IsDistributedOverTheLoopAndTheClosure) {
  // 40 edges and a closure with equal scale information and no pose information: each edge takes
  // 1/41 of the gap of 40 creeps.
  const ScaleDrift square = scale_drift(0.02, 1e-12);
  ASSERT_TRUE(has_scale_drift(square.problem));
  const Problem rigid = remove_scale_drift(square.problem);
  EXPECT_FALSE(has_scale_drift(rigid));
  for (const std::size_t i : {1u, 10u, 39u}) {
    const double remaining = std::exp(0.02 * static_cast<double>(i) * (40.0 / 41.0 - 1.0));
    EXPECT_NEAR(rigid.odometry[i].from_from_to.translation.x(), remaining, 1e-9);
  }
  // 1e4 in a scale of exp(0.02 * 400 / 41): the deviation grows with the scale.
  EXPECT_NEAR(rigid.odometry[10].information(0, 0), 1e4 * std::exp(-2.0 * 8.0 / 41.0), 1e-4);
  EXPECT_NEAR(rigid.odometry[10].information(5, 5), 1e4, 1e-9);
}

TEST(ScaleDrift, IsSharedByOverlappingLoops) {
  // Chain of 3 edges, loops 0-2 and 1-3 with log scales 1 and 2: (N + I) = [3 1; 1 3], so
  // lambda = (1/8, 5/8) and the edges change by 1/8, 6/8, 5/8.
  Problem problem = along_x({0, 1, 2, 3});
  const Matrix6 weak = Matrix6::Identity() * 1e-12;
  problem.closures = {{0, 2, at_x(2), weak, std::exp(1.0)}, {1, 3, at_x(2), weak, std::exp(2.0)}};
  const Problem rigid = remove_scale_drift(problem);
  EXPECT_NEAR(rigid.odometry[0].from_from_to.translation.x(), 1.0, 1e-9);
  EXPECT_NEAR(rigid.odometry[1].from_from_to.translation.x(), std::exp(1.0 / 8), 1e-9);
  EXPECT_NEAR(rigid.odometry[2].from_from_to.translation.x(), std::exp(7.0 / 8), 1e-9);
  EXPECT_NEAR(rigid.closures[1].from_from_to.translation.x(), 2.0 * std::exp(1.0 / 8), 1e-9);
  EXPECT_NEAR(rigid.keyframes[3].world_from_body.translation.x(),
              1 + std::exp(0.125) + std::exp(0.875),
              1e-9);
}

TEST(ScaleDrift, DualEqualsTheSim3PoseGraph) {
  const ScaleDrift square = scale_drift(0.01, 1e4);
  const Trajectory graph = corrected<PoseGraphOptimizer>(square.problem);
  const Trajectory dual = corrected<Dual>(square.problem);
  const Trajectory rigid = corrected<Dual>(square.problem, {.scale = false});
  EXPECT_LT(rmse(dual, square.truth), 0.1 * rmse(rigid, square.truth));
  EXPECT_LT(rmse(dual, graph), 1e-3 * rmse(rigid, graph));
}

TEST(ScaleDrift, DualWeightsTranslationInTheSameScaleAsThePoseGraph) {
  // The scale grows by e over the loop; deviations are in the scale of an edge's first keyframe.
  const ScaleDrift square = scale_drift(0.025, 1e4);
  EXPECT_NEAR(Sim3::information(square.problem.closures[0], 0.01)(0, 0), 1e4 * std::exp(2.0), 1e-6);
  const Problem rigid = remove_scale_drift(square.problem);
  EXPECT_NEAR(rigid.closures[0].information(0, 0), 1e4, 1e-9);

  const Trajectory dual = corrected<Dual>(square.problem);
  std::vector<ScaledPose> poses;
  for (std::size_t i = 0; i < dual.size(); ++i) {
    poses.push_back({dual[i].world_from_body, 1.0});
    if (i < rigid.odometry.size()) {
      poses[i].scale = rigid.odometry[i].from_from_to.translation.norm() /
                       square.problem.odometry[i].from_from_to.translation.norm();
    } else {
      poses[i].scale = poses[i - 1].scale * poses[i - 1].scale / poses[i - 2].scale;  // even shares
    }
  }
  double chi2 = 0.0;
  const PoseGraphSettings settings{.group = Group::sim3};
  for (const auto* edges : {&square.problem.odometry, &square.problem.closures}) {
    for (const double each : squared_errors(poses, *edges, settings)) chi2 += each;
  }
  Report graph;
  PoseGraphOptimizer({}).correct(square.problem, graph);
  const double minimum = count(graph, "chi2");
  EXPECT_GT(chi2, minimum * (1.0 - 1e-9));
  EXPECT_LT(chi2, minimum * 1.001);
}

}  // namespace
}  // namespace loopbench::scale_drift_test
