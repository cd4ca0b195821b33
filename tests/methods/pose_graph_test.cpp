#include "methods/correctors/pose_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/checked.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/solvers/groups/sim3.hpp"
#include "methods/solvers/initial_values.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::pose_graph_test {
namespace {

using Options = PoseGraphOptimizer::Options;

constexpr auto optimised = [](const Problem& problem, const Options& options = {}) {
  return corrected<PoseGraphOptimizer>(problem, options);
};

double largest_difference(const Trajectory& a, const Trajectory& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Twist d = log_se3(a[i].world_from_body.inverse() * b[i].world_from_body);
    largest = std::max(largest, d.norm());
  }
  return largest;
}

TEST(PoseGraph, RobustLossesReduceTheInfluenceOfOutliers) {
  Problem problem = walk(2, 30, 0.01);
  problem.closures.resize(1);
  problem.closures[0].from_from_to.translation.x() += 50.0;
  const auto moved = [&](RobustLoss loss) {
    const std::size_t to = problem.closures[0].to;
    return distances(optimised(problem, {.loss = loss}), problem.keyframes)[to];
  };
  const double plain = moved(RobustLoss::none);
  EXPECT_GT(plain, 10.0);
  EXPECT_LT(moved(RobustLoss::huber), 0.2 * plain);
  EXPECT_LT(moved(RobustLoss::cauchy), moved(RobustLoss::huber));
  EXPECT_LT(moved(RobustLoss::dcs), 0.01 * plain);
}

TEST(PoseGraph, DistributesAGapEvenly) {
  // Steps measured as 1 m, the total as 2.3 m: 0.3 m over three equal variances, 0.1 m each, chi2
  // 3 * 0.01. In every group, and from the loop equations.
  using Poses = PoseGraphOptimizer::Poses;
  Problem problem = along_x({0, 1, 2});
  problem.closures = {{0, 2, at_x(2.3)}};
  const auto expect_even = [&](bool planar, const Options& options) {
    problem.planar = planar;
    Report report;
    expect_positions(corrected<PoseGraphOptimizer>(problem, options, &report), {0, 1.1, 2.2}, 1e-9);
    EXPECT_NEAR(count(report, "chi2"), 0.03, 1e-12);
    return report;
  };
  for (const Poses group : {Poses::se2, Poses::se3, Poses::sim3}) {
    SCOPED_TRACE(to_text(group));
    const Report report = expect_even(true, {.group = group, .scale_sigma = 1e-9});
    EXPECT_NEAR(count(report, "chi2_before"), 0.09, 1e-12);
  }
  for (const bool planar : {false, true}) {
    SCOPED_TRACE(planar ? "planar" : "spatial");
    const Report report = expect_even(planar, {.start = PoseGraphOptimizer::Start::chordal});
    EXPECT_LE(count(report, "iterations"), 12.0);
  }
}

TEST(PoseGraph, DistributesAScaleChangeEvenly) {
  // Four steps without scale change and a closure with a scale change of 16: five edges of equal
  // information take a fifth of its logarithm each, so steps grow by q = 16^(1/5). The closure's
  // length matches such a path, so only scales are inconsistent.
  const double q = std::pow(16.0, 0.2);
  Problem problem = along_x({0, 1, 2, 3, 4});
  problem.closures.push_back({0, 4, at_x(1.0 + q + q * q + q * q * q)});
  problem.closures[0].scale = 16.0;
  Report report;
  const Trajectory out =
      PoseGraphOptimizer({.start = PoseGraphOptimizer::Start::chordal}).correct(problem, report);
  double x = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_NEAR(out[i].world_from_body.translation.x(), x, 1e-6) << i;
    x += std::pow(q, static_cast<double>(i));
  }
  const double share = std::log(q) / 0.01;  // scale_sigma
  EXPECT_NEAR(count(report, "chi2"), 5.0 * share * share, 2e-6);
}

TEST(PoseGraph, ScalesHaveTheirStatedInformation) {
  // Four edges whose log scale has variance 1 and a closure of variance 4 share log(16): an eighth
  // for each edge, four eighths for the closure. Its length matches such a path.
  const double q = std::pow(16.0, 0.125);
  Problem problem = along_x({0, 1, 2, 3, 4});
  for (Edge& edge : problem.odometry) edge.scale_information = 1.0;
  problem.closures.push_back({0, 4, at_x(1.0 + q + q * q + q * q * q)});
  problem.closures[0].scale = 16.0;
  problem.closures[0].scale_information = 0.25;
  for (const auto start :
       {PoseGraphOptimizer::Start::odometry, PoseGraphOptimizer::Start::chordal}) {
    Report report;
    const Trajectory out = PoseGraphOptimizer({.start = start}).correct(problem, report);
    double x = 0.0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      EXPECT_NEAR(out[i].world_from_body.translation.x(), x, 1e-6) << i;
      x += std::pow(q, static_cast<double>(i));
    }
    EXPECT_NEAR(count(report, "chi2"), 8.0 * std::log(q) * std::log(q), 1e-8);
  }
}

TEST(PoseGraph, AcceptsConnectedGraphsOnly) {
  Problem problem = walk(6, 30, 0.0);
  problem.odometry.erase(problem.odometry.begin() + 20);
  const PoseGraphOptimizer method({});
  EXPECT_EQ(method.why_declined(problem), "");  // a closure joins the two parts
  std::mt19937_64 random(1);
  const Trajectory truth = walk(6, 30, 0.0).keyframes;
  for (std::size_t i = 21; i < 30; ++i) {  // the second part starts from wrong poses
    Pose& pose = problem.keyframes[i].world_from_body;
    pose = pose * exp_se3(random_twist(random, 0.1, 0.05));
  }
  EXPECT_NEAR(largest_difference(optimised(problem), truth), 0.0, 1e-6);
  for (const auto start :
       {PoseGraphOptimizer::Start::odometry, PoseGraphOptimizer::Start::chordal}) {
    EXPECT_NEAR(largest_difference(optimised(problem, {.start = start}), truth), 0.0, 1e-6);
  }
  std::erase_if(problem.closures, [](const Edge& e) { return e.from < 21 && e.to >= 21; });
  ASSERT_FALSE(problem.closures.empty());
  EXPECT_EQ(method.why_declined(problem),
            "the graph is not connected: no path from keyframe 0.0 s to keyframe 21.0 s");
  for (int i = 0; i < 30; ++i) problem.ids.push_back(100 + 2 * i);
  EXPECT_EQ(method.why_declined(problem),
            "the graph is not connected: no path from keyframe 100 to keyframe 142");
}

TEST(PoseGraph, FindsTheSameMinimumInThePlaneAndInSpace) {
  const Pose tilted{exp_so3({0.4, -1.1, 2.0}), {30.0, -20.0, 10.0}};
  const Problem problem = moved_by(tilted, planar());
  Report in_plane, in_space;
  const Trajectory a = PoseGraphOptimizer({}).correct(problem, in_plane);
  const Trajectory b =
      PoseGraphOptimizer({.group = PoseGraphOptimizer::Poses::se3}).correct(problem, in_space);
  EXPECT_NEAR(largest_difference(a, b), 0.0, 1e-7);
  EXPECT_NEAR(count(in_plane, "chi2"), count(in_space, "chi2"), 1e-9 * count(in_space, "chi2"));
  Problem spatial = problem;
  spatial.planar = false;
  EXPECT_EQ(PoseGraphOptimizer({.group = PoseGraphOptimizer::Poses::se2}).why_declined(spatial),
            "group is se2, but the problem is not planar");
}

TEST(PoseGraph, ChordalValuesAreExactWhenMeasurementsAre) {
  const Problem problem = walk(8, 40, 0.0);
  EliminationCache cache;
  const std::vector<ScaledPose> values = chordal_values(problem, 0.01, cache);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_POSE_NEAR(values[i].pose, problem.keyframes[i].world_from_body, 1e-8, 1e-8) << i;
  }
}

TEST(PoseGraph, RejectsSingularInformation) {
  Problem problem = walk(2, 10, 0.01);
  problem.odometry[3].information.setZero();
  EXPECT_THROW(optimised(problem), std::runtime_error);
}

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
}  // namespace loopbench::test::pose_graph_test
