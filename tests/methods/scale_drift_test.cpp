// Chains whose scale drifts: which methods estimate it.
#include "methods/correctors/chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "methods/correctors/checked.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "tests/support/corrected.hpp"

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

ScaleDrift scale_drift(double creep) {
  ScaleDrift out;
  Pose pose;
  Pose measured_pose;
  double unit = 1.0;  // current scale; a true metre is one unit at the start
  const Matrix6 information = Matrix6::Identity() * 1e4;
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
  out.problem.closures.push_back({0, 40, pose, information, unit});
  return out;
}

TEST(ScaleDrift, IsRemovedByThePoseGraph) {
  const ScaleDrift square = scale_drift(0.01);
  ASSERT_TRUE(has_scale_drift(square.problem));
  const Trajectory graph = corrected<PoseGraphOptimizer>(square.problem);
  const Trajectory rigid =
      corrected<PoseGraphOptimizer>(square.problem, {.group = PoseGraphOptimizer::Poses::se3});
  EXPECT_LT(rmse(graph, square.truth), 0.1 * rmse(rigid, square.truth));
}

TEST(ScaleDrift, IsDeclinedByDual) {
  const Problem problem = scale_drift(0.01).problem;
  EXPECT_THAT(Dual({}).why_declined(problem), ::testing::HasSubstr("use pose_graph"));
  EXPECT_THAT(PairwiseConsistent<Dual>({}).why_declined(problem),
              ::testing::HasSubstr("use pose_graph"));
}

// Deviations are in the scale of an edge's first keyframe; the information is in that of the
// second.
TEST(ScaleDrift, TranslationIsWeightedInTheScaleOfTheFirstKeyframe) {
  const Edge closure = scale_drift(0.025).problem.closures[0];  // the scale grows by e
  EXPECT_NEAR(Sim3::information(closure, 0.01)(0, 0), 1e4 * std::exp(2.0), 1e-6);
}

}  // namespace
}  // namespace loopbench::scale_drift_test
