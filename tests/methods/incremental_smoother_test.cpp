/// pose_graph_incremental and dual_incremental: the minimum of pose_graph and dual, reached in
/// parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/dual_incremental.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/correctors/pose_graph_incremental.hpp"
#include "methods/solvers/elimination_order.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::incremental_smoother_test {

using namespace methods;

namespace {

/// Until no correction exceeds the tolerance.
constexpr IncrementalSettings kExact{.decrease = 0.0};

/// Keyframes `begin` to `end` - 1, their odometry, and the closures that end there.
Increment part(const Problem& problem, std::size_t begin, std::size_t end) {
  Increment out;
  for (std::size_t i = begin; i < end; ++i) {
    out.keyframes.push_back(problem.keyframes[i]);
    if (i > 0) out.odometry.push_back(problem.odometry[i - 1]);
  }
  for (const Edge& closure : problem.closures) {
    if (closure.to >= begin && closure.to < end) out.closures.push_back(closure);
  }
  return out;
}

/// Of the problem, in parts of 20 keyframes.
Trajectory in_parts(const Problem& problem, const Corrector& method, Report& report) {
  const auto incremental = method.incremental(problem.planar);
  Trajectory out;
  for (std::size_t begin = 0; begin < problem.keyframes.size(); begin += 20) {
    out = incremental->update(part(problem, begin, begin + 20), report);
    EXPECT_EQ(out.size(), begin + 20);
  }
  return out;
}

/// Of all updates.
double iterations(const Report& report) {
  double out = 0.0;
  for (const Count& each : report.counts) {
    if (each.name == "iterations") out += each.value;
  }
  return out;
}

TEST(DualIncremental, ReachesTheMinimumOfDualInParts) {
  for (const bool planar : {false, true}) {
    Problem problem = test::walk(2, 80, 0.02);
    problem.planar = planar;
    Report report;
    const Trajectory expected = test::corrected<Dual>(problem);
    test::expect_close(in_parts(problem, DualIncremental({}), report), expected, 1e-6);
    test::expect_close(test::corrected<DualIncremental>(problem), expected, 1e-6);
  }
}

TEST(PoseGraph, KeepsItsOrderInPartsAndReachesTheSameMinimum) {
  const Problem problem = test::walk(2, 80, 0.02);
  Report report;
  const PoseGraphOptimizer method({.keep_order = 3.0});
  const Trajectory expected = test::corrected<PoseGraphOptimizer>(problem);
  test::expect_close(in_parts(problem, method, report), expected, 1e-6);
  // The first update has no closure yet: it is declined.
  ASSERT_GE(report.counts.size(), 2u);
  EXPECT_EQ(report.counts[report.counts.size() - 2].name, "orders");
  EXPECT_EQ(report.counts[report.counts.size() - 2].value, 1.0);
  EXPECT_EQ(report.counts.back().name, "updates_declined");
}

TEST(PoseGraph, RescalesInPartsAsAtOnce) {
  const Problem problem = test::walk(2, 80, 0.02);
  const auto options = [](std::optional<double> keep_order) {
    return PoseGraphOptimizer::Options{.rescale = true, .keep_order = keep_order};
  };
  const PoseGraphOptimizer method(options(2.0));
  Report report;
  test::expect_close(in_parts(problem, method, report),
                     PoseGraphOptimizer(options({})).correct(problem, report),
                     1e-6);
}

TEST(PoseGraph, KeepsAnOrderOnlyWithoutALoss) {
  EXPECT_EQ(PoseGraphOptimizer({}).incremental(false), nullptr);
  const PoseGraphOptimizer robust({.loss = RobustLoss::huber, .keep_order = 2.0});
  EXPECT_THAT(robust.why_declined(test::walk(2, 80, 0.02)), ::testing::HasSubstr("loss: none"));
}

TEST(DualIncremental, AnAgreeingClosureAddsRowsOnly) {
  Problem problem = test::walk(2, 80, 0.02);
  const auto method = DualIncremental({}).incremental(false);
  Report first;
  const Trajectory solved = method->update(part(problem, 0, 80), first);
  EXPECT_GE(test::count(first, "assemblies"), 1.0);
  const Pose measured = solved[10].world_from_body.inverse() * solved[70].world_from_body;
  Increment added;
  added.closures = {{10, 70, measured * exp_se3(Twist::Constant(1e-4)), Matrix6::Identity() * 1e4}};
  Report second;
  const Trajectory last = method->update(added, second);
  EXPECT_EQ(test::count(second, "assemblies"), 0.0);
  problem.closures.push_back(added.closures[0]);
  test::expect_close(last, test::corrected<Dual>(problem), 1e-6);
}

TEST(DualIncremental, RemovesWithdrawnClosures) {
  Problem problem = test::walk(3, 50, 0.02);
  const auto method = DualIncremental({}).incremental(false);
  Report report;
  method->update(part(problem, 0, 50), report);
  Increment withdrawal;
  withdrawal.withdrawn = {problem.closures[1]};
  const Trajectory last = method->update(withdrawal, report);
  Problem left = problem;
  left.closures.erase(left.closures.begin() + 1);
  test::expect_close(last, test::corrected<Dual>(left), 1e-6);
  withdrawal.withdrawn = left.closures;
  const Trajectory none = method->update(withdrawal, report);
  test::expect_close(none, problem.keyframes, 1e-9);  // odometry again
}

TEST(IncrementalSmoother, ReachesTheMinimumOfThePoseGraph) {
  for (const bool planar : {false, true}) {
    Problem problem = planar ? test::planar() : test::walk(1, 60, 0.02);
    test::expect_close(test::corrected<IncrementalPoseGraph>(problem, kExact),
                       test::corrected<PoseGraphOptimizer>(problem),
                       1e-6);
  }
}

TEST(IncrementalSmoother, EndsBeforeALinearisationThatHardlyLowersTheCost) {
  const Problem problem = test::walk(2, 80, 0.02);
  Report exact_report;
  const Trajectory exact = in_parts(problem, IncrementalPoseGraph(kExact), exact_report);
  Report report;
  const IncrementalPoseGraph early(IncrementalSettings{});
  const Trajectory solved = in_parts(problem, early, report);
  EXPECT_LT(iterations(report), iterations(exact_report));
  EXPECT_TRUE(report.notes.empty());
  test::expect_close(solved, exact, 1e-4);
}

TEST(IncrementalSmoother, EndsWithTheSameResultInParts) {
  const Problem problem = test::walk(2, 80, 0.02);
  Report report;
  test::expect_close(in_parts(problem, IncrementalPoseGraph(kExact), report),
                     test::corrected<IncrementalPoseGraph>(problem, kExact),
                     1e-6);
}

TEST(IncrementalSmoother, RemovesWithdrawnClosures) {
  Problem problem = test::walk(3, 50, 0.02);
  const auto method = IncrementalPoseGraph(kExact).incremental(false);
  Report report;
  method->update(part(problem, 0, 50), report);
  Increment withdrawal;
  withdrawal.withdrawn = {problem.closures[1]};
  const Trajectory last = method->update(withdrawal, report);
  problem.closures.erase(problem.closures.begin() + 1);
  test::expect_close(last, test::corrected<IncrementalPoseGraph>(problem, kExact), 1e-6);
}

TEST(IncrementalSmoother, EliminatesThePosesOfTheLoopOnly) {
  Problem problem = test::walk(4, 1000, 0.001);
  problem.closures = {
      {980,
       999,
       normalized(problem.keyframes[980].world_from_body.inverse() *
                  problem.keyframes[999].world_from_body * exp_se3(Twist::Constant(0.001)))}};
  const auto method = IncrementalPoseGraph(kExact).incremental(false);
  Report first;
  method->update(part(problem, 0, 998), first);
  EXPECT_EQ(test::count(first, "eliminations"), 997.0);  // once each but the fixed one
  Report second;
  method->update(part(problem, 998, 1000), second);
  // The loop has 20 poses, and the root of the tree was the newest one before.
  EXPECT_LE(test::count(second, "eliminations"), 21.0 * test::count(second, "iterations"));
}

TEST(IncrementalSmoother, RejectsAFalseClosureByTheIncreaseOfTheCost) {
  Problem problem = test::walk(5, 60, 0.02);
  const Trajectory expected = test::corrected<IncrementalPoseGraph>(problem, kExact);
  Edge wrong = problem.closures[1];
  wrong.to = 40;
  problem.closures.insert(problem.closures.begin() + 1, wrong);
  Report report;
  const Trajectory gated = test::corrected<IncrementalPoseGraph>(
      problem, {.decrease = 0.0, .robust = IncrementalRobustness::gate}, &report);
  EXPECT_EQ(test::count(report, "closures_kept"), 3.0);
  test::expect_close(gated, expected, 1e-6);
}

TEST(IncrementalSmoother, WeighsAFalseClosureDown) {
  // A straight line of 1 m steps; steps and closure have sigma 0.1 m. The closure is 6 m short of 8
  // m.
  Problem problem = test::along_x({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  for (Edge& edge : problem.odometry) edge.information = Matrix6::Identity() * 100.0;
  problem.closures = {{0, 8, test::at_x(2.0), Matrix6::Identity() * 100.0}};
  const IncrementalSettings graduated{.decrease = 0.0, .robust = IncrementalRobustness::graduated};
  const Trajectory kept = test::corrected<IncrementalPoseGraph>(problem, graduated);
  // chi2 of the closure is 3600, its weight (16.8 / 3617)^2 = 2e-5, and it moves 8 / (8 + 1 / 2e-5)
  // of 6 m.
  EXPECT_NEAR(kept[8].world_from_body.translation.x(), 8.0, 2e-3);
  // A closure that agrees counts almost fully: 8 / 9 of 0.01 m.
  problem.closures[0].from_from_to = test::at_x(7.99);
  const Trajectory moved = test::corrected<IncrementalPoseGraph>(problem, graduated);
  EXPECT_NEAR(moved[8].world_from_body.translation.x(), 8.0 - 0.01 * 8.0 / 9.0, 1e-5);
}

TEST(EliminationOrder, IsAPermutationThatEndsWithTheLastPose) {
  const std::vector<std::size_t> poses{2, 3, 5, 8, 9};
  std::vector<std::size_t> order = elimination_order(poses, {{2, 3}, {3, 5, 7}, {8, 9}, {2, 9}});
  EXPECT_EQ(order.back(), 9u);
  std::ranges::sort(order);
  EXPECT_EQ(order, poses);
  EXPECT_TRUE(elimination_order({}, {}).empty());
}

}  // namespace
}  // namespace loopbench::incremental_smoother_test
