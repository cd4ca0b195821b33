// Absolute positions: splits worked by hand, both solvers against each other, and the first pose.
#include "methods/correctors/anchors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "datasets/derive/closures.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/two_pass.hpp"
#include "methods/correctors/uniform.hpp"
#include "methods/solvers/residuals.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::anchors_test {
namespace {

Anchor anchor(std::size_t keyframe, const Vector3& position, double variance) {
  return {keyframe, position, variance * Matrix3::Identity()};
}

const Pose kElsewhere{exp_so3({0.4, -1.1, 2.0}), {30.0, -20.0, 10.0}};

// Four unit steps of variance 1, the last position measured at 5 with variance 1. Five equal
// variances share the gap of 1: each edge and the anchor take 0.2, chi2 = 5 * 0.04.
TEST(Anchors, OneAnchorIsSharedByVariance) {
  Problem problem = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  problem.anchors = {anchor(4, {5.0, 0.0, 0.0}, 1.0)};
  Report dual, graph;
  const std::vector<double> expected{0.0, 1.2, 2.4, 3.6, 4.8};
  expect_positions(corrected<Dual>(problem, {}, &dual), expected, 1e-10);
  expect_positions(corrected<PoseGraphOptimizer>(problem, {}, &graph), expected, 1e-10);
  for (const Report* report : {&dual, &graph}) {
    EXPECT_NEAR(count(*report, "chi2"), 0.2, 1e-10);
    EXPECT_NEAR(count(*report, "chi2_per_dof"), 0.2 / 3.0, 1e-10);
    ASSERT_FALSE(report->notes.empty());
    EXPECT_NE(report->notes.front().find("the first keyframe is held"), std::string::npos);
  }
  const std::vector<double> met{0.0, 1.25, 2.5, 3.75, 5.0};
  expect_positions(corrected<Uniform>(problem), met, 1e-12);
  expect_positions(corrected<TwoPass>(problem), met, 1e-12);
}

// In the plane, two anchors free the first pose. Variances 4 x 1 and 2 x 0.25 share the gap of 0.9:
// each edge takes 0.2, each anchor 0.05.
TEST(Anchors, TheFirstPoseIsFreeIfTheyDetermineTheFrame) {
  Problem problem = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  problem.planar = true;
  problem.anchors = {anchor(0, Vector3::Zero(), 0.25), anchor(4, {4.9, 0.0, 0.0}, 0.25)};
  const std::vector<double> expected{0.05, 1.25, 2.45, 3.65, 4.85};
  expect_positions(corrected<Dual>(problem), expected, 1e-9);
  expect_positions(corrected<PoseGraphOptimizer>(problem), expected, 1e-9);
  problem.planar = false;  // two points leave the rotation about their line open
  EXPECT_FALSE(UsedAnchors(problem).is_first_free);
}

TEST(Anchors, CovariancesCountPerAxis) {
  Problem problem = along_x({0.0, 1.0});
  problem.anchors = {anchor(1, {2.0, 0.0, 0.0}, 1.0)};
  problem.anchors[0].covariance(0, 0) = 3.0;  // the edge has 1, so it takes a quarter of the gap
  expect_positions(corrected<Dual>(problem), {0.0, 1.25}, 1e-10);
  expect_positions(corrected<PoseGraphOptimizer>(problem), {0.0, 1.25}, 1e-10);
}

TEST(Anchors, JacobianEqualsNumericalDerivative) {
  const Pose pose{exp_so3({0.3, -0.7, 1.1}), {2.0, -1.0, 0.5}};
  const Anchor at{0, {1.0, 2.0, 3.0}, Matrix3::Identity(), {0.4, -0.2, 0.1}};
  const AnchorResidual residual = anchor_residual(at, pose);
  for (Eigen::Index d = 0; d < 6; ++d) {
    const auto moved = [&](double by) {
      return anchor_residual(at, pose * exp_se3(by * Twist::Unit(d))).error;
    };
    const Vector3 numeric = (moved(1e-6) - moved(-1e-6)) / 2e-6;
    EXPECT_NEAR((residual.by_pose.col(d) - numeric).norm(), 0.0, 1e-8) << d;
  }
}

/// Anchors at every seventh keyframe of the true path, with errors of about 5 cm and a lever arm.
Problem anchored(Problem problem, const Trajectory& truth) {
  const Vector3 lever(0.3, -0.1, problem.planar ? 0.0 : 0.2);
  for (std::size_t i = 3; i < truth.size(); i += 7) {
    const double s = static_cast<double>(i);
    const Vector3 error(0.05 * std::sin(s), 0.05 * std::cos(2.0 * s), 0.04 * std::sin(3.0 * s));
    Anchor at = anchor(i, truth[i].world_from_body * lever + error, 2.5e-3);
    at.covariance(0, 1) = at.covariance(1, 0) = 1e-3;
    at.point_in_body = lever;
    problem.anchors.push_back(at);
  }
  return problem;
}

/// Rounds on a circle of 5 m, forty keyframes each.
Trajectory rounds(std::size_t count) {
  Trajectory out;
  for (std::size_t i = 0; i <= 40 * count; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / 40.0;
    out.push_back({0.5 * static_cast<double>(i),
                   turned_about_z(angle, 5.0 * Vector3(std::cos(angle), std::sin(angle), 0.0))});
  }
  return out;
}

TEST(Anchors, DualAndPoseGraphFindTheSameMinimum) {
  for (const Problem& base : {hand_held(), planar()}) {
    // In space, the frame of the estimate is another one.
    Problem problem = anchored(base.planar ? base : moved_by(kElsewhere, base), base.keyframes);
    ASSERT_TRUE(UsedAnchors(problem).is_first_free);
    for (const bool with_loops : {true, false}) {
      if (!with_loops) problem.closures.clear();
      Report dual, graph;
      const Trajectory a = corrected<Dual>(problem, {}, &dual);
      const Trajectory b = corrected<PoseGraphOptimizer>(problem, {}, &graph);
      expect_close(a, b, 1e-6);
      const double chi2 = count(graph, "chi2");
      EXPECT_NEAR(count(dual, "chi2"), chi2, 1e-7 * chi2);
      EXPECT_LT(count(dual, "iterations"), 60.0);
    }
  }
}

// Rounds with a yaw drift of 69 or 137 degrees per round: from the aligned keyframes, the equations
// of the loops can end in a minimum of seven times the cost.
TEST(Anchors, DualFindsTheMinimumOfPoseGraphAfterMuchDrift) {
  double largest = 1.0;  // cost of dual from the keyframes over that of pose_graph
  for (const auto& [count_of_rounds, bias] : {std::pair{2u, 0.06}, {3u, 0.03}, {3u, 0.06}}) {
    const Trajectory truth = rounds(count_of_rounds);
    const Pairs loops = count_of_rounds == 2 ? Pairs{{0, 40}, {0, 80}}  //
                                             : Pairs{{0, 40}, {0, 80}, {0, 120}};
    Problem problem = drifting(truth, twist(Vector3::Zero(), {0.0, 0.0, bias}), loops);
    problem.planar = true;
    for (std::size_t i = 13; i < truth.size(); i += 27) {
      problem.anchors.push_back(anchor(i, truth[i].world_from_body.translation, 2.5e-3));
    }
    Report dual, graph, keyframes;
    const Trajectory a = corrected<Dual>(problem, {}, &dual);
    const PoseGraphOptimizer::Options chordal{.start = PoseGraphOptimizer::Start::chordal};
    expect_close(a, corrected<PoseGraphOptimizer>(problem, chordal, &graph), 1e-6);
    const double chi2 = count(graph, "chi2");
    EXPECT_NEAR(count(dual, "chi2"), chi2, 1e-7 * chi2);
    corrected<Dual>(problem, {.start = Dual::Start::keyframes}, &keyframes);
    EXPECT_EQ(count(keyframes, "chi2_before"), count(dual, "chi2_before"));
    largest = std::max(largest, count(keyframes, "chi2") / chi2);
  }
  EXPECT_GT(largest, 1.5);
}

TEST(Anchors, DualNamesPoseGraphAboveItsLimit) {
  Problem problem = along_x({0.0, 1.0, 2.0});
  problem.anchors = {anchor(1, {1.0, 0.0, 0.0}, 1.0), anchor(2, {2.0, 0.0, 0.0}, 1.0)};
  EXPECT_EQ(Dual({.max_closures = 1}).why_declined(problem),
            "0 closures and 2 anchors exceed max_closures = 1: use pose_graph");
  EXPECT_EQ(Dual({.max_closures = 2}).why_declined(problem), "");
}

TEST(Anchors, ExactOnesMoveAPerfectPathToTheirWorld) {
  const Problem truth = perfect();
  Problem problem = moved_by(kElsewhere, truth);
  for (const std::size_t i : {std::size_t{5}, std::size_t{20}, std::size_t{33}, std::size_t{57}}) {
    problem.anchors.push_back(anchor(i, truth.keyframes[i].world_from_body.translation, 1e-4));
  }
  expect_close(corrected<Dual>(problem), truth.keyframes, 1e-8);
  expect_close(corrected<PoseGraphOptimizer>(problem), truth.keyframes, 1e-8);
  expect_close(corrected<Uniform>(problem), truth.keyframes, 1e-8);
  expect_close(corrected<TwoPass>(problem), truth.keyframes, 1e-8);
}

// Loops are closed first; then positions between two anchors are shifted linearly.
TEST(Anchors, SpreadingRulesMeetThemAndAveragesAtOneKeyframe) {
  Problem problem = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  problem.anchors = {anchor(2, {3.0, 0.0, 0.0}, 1.0), anchor(2, {5.0, 0.0, 0.0}, 3.0)};
  // Weights 3/4 and 1/4: 3.5 at keyframe 2, 1.5 more than the estimate, and so after it.
  expect_positions(corrected<Uniform>(problem), {0.0, 1.75, 3.5, 4.5, 5.5}, 1e-12);
}

TEST(Anchors, EdgesThatChangeTheScaleDecline) {
  Problem problem = circle();
  problem.anchors = {anchor(4, Vector3::Zero(), 1.0)};
  problem.closures.front().scale = 1.1;
  const std::string why = "anchors require edges of scale 1, but edges change the scale";
  EXPECT_EQ(Dual({}).why_declined(problem), why);
  EXPECT_EQ(PoseGraphOptimizer({}).why_declined(problem), why);
  EXPECT_EQ(Uniform({}).why_declined(problem), why);
}

TEST(Anchors, MustBeSortedAndPositiveDefinite) {
  Problem problem = circle();
  problem.anchors = {anchor(4, Vector3::Zero(), 1.0), anchor(2, Vector3::Zero(), 1.0)};
  EXPECT_THROW(check(problem, "p"), InputError);
  problem.anchors = {anchor(41, Vector3::Zero(), 1.0)};
  EXPECT_THROW(check(problem, "p"), InputError);
  problem.anchors = {anchor(4, Vector3::Zero(), 0.0)};
  EXPECT_THROW(check(problem, "p"), InputError);
}

// The gap of a straight path is its length. Its rotation is unknown, so that none is distributed.
TEST(StartEqualsEnd, ClosesThePositionOnly) {
  Problem problem = along_x({0.0, 1.0, 2.0, 1.5, 1.0});
  problem.keyframes.back().world_from_body.rotation = exp_so3({0.0, 0.0, 0.5});
  problem.odometry.back().from_from_to.rotation = exp_so3({0.0, 0.0, 0.5});
  problem.closures = {start_equals_end(problem.keyframes, 1.0)};
  ASSERT_NO_THROW(check(problem, "p"));
  const Trajectory uniform = corrected<Uniform>(problem);
  expect_positions(uniform, {0.0, 0.75, 1.5, 0.75, 0.0}, 1e-12);
  EXPECT_NEAR(angle_between(uniform.back().world_from_body.rotation,
                            problem.keyframes.back().world_from_body.rotation),
              0.0,
              1e-12);
}

}  // namespace
}  // namespace loopbench::test::anchors_test
