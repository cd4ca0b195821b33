/// pose_graph_incremental: the minimum of pose_graph, reached in parts.
#include <gtest/gtest.h>

#include <algorithm>

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

TEST(IncrementalSmoother, ReachesTheMinimumOfThePoseGraph) {
  for (const bool planar : {false, true}) {
    Problem problem = planar ? test::planar() : test::walk(1, 60, 0.02);
    test::expect_close(test::corrected<IncrementalPoseGraph>(problem),
                       test::corrected<PoseGraphOptimizer>(problem),
                       1e-6);
  }
}

TEST(IncrementalSmoother, EndsWithTheSameResultInParts) {
  const Problem problem = test::walk(2, 80, 0.02);
  const auto method = IncrementalPoseGraph({}).incremental(false);
  Report report;
  Trajectory last;
  for (std::size_t begin = 0; begin < 80; begin += 20) {
    last = method->update(part(problem, begin, begin + 20), report);
    EXPECT_EQ(last.size(), begin + 20);
  }
  test::expect_close(last, test::corrected<IncrementalPoseGraph>(problem), 1e-6);
}

TEST(IncrementalSmoother, RemovesWithdrawnClosures) {
  Problem problem = test::walk(3, 50, 0.02);
  const auto method = IncrementalPoseGraph({}).incremental(false);
  Report report;
  method->update(part(problem, 0, 50), report);
  Increment withdrawal;
  withdrawal.withdrawn = {problem.closures[1]};
  const Trajectory last = method->update(withdrawal, report);
  problem.closures.erase(problem.closures.begin() + 1);
  test::expect_close(last, test::corrected<IncrementalPoseGraph>(problem), 1e-6);
}

TEST(IncrementalSmoother, EliminatesThePosesOfTheLoopOnly) {
  Problem problem = test::walk(4, 1000, 0.001);
  problem.closures = {
      {980,
       999,
       normalized(problem.keyframes[980].world_from_body.inverse() *
                  problem.keyframes[999].world_from_body * exp_se3(Twist::Constant(0.001)))}};
  const auto method = IncrementalPoseGraph({}).incremental(false);
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
  const Trajectory expected = test::corrected<IncrementalPoseGraph>(problem);
  Edge wrong = problem.closures[1];
  wrong.to = 40;
  problem.closures.insert(problem.closures.begin() + 1, wrong);
  Report report;
  const Trajectory gated = test::corrected<IncrementalPoseGraph>(problem, {.gate = true}, &report);
  EXPECT_EQ(test::count(report, "closures_kept"), 3.0);
  test::expect_close(gated, expected, 1e-6);
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
