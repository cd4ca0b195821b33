#include "methods/correctors/dual.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::dual_test {
namespace {

TEST(Dual, FindsTheMinimumOfThePoseGraph) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const Problem problem = walk(seed, 14, 0.05);
    const Trajectory dual = corrected<Dual>(problem, {.max_iterations = 100, .tolerance = 0.0});
    const Trajectory graph = corrected<PoseGraphOptimizer>(problem);
    expect_close(dual, graph, 1e-6);
    expect_minimum(problem, poses_of(dual));
    const double cost = chain_cost(problem, poses_of(dual));
    EXPECT_NEAR(cost, chain_cost(problem, poses_of(graph)), 1e-9 * cost);
    EXPECT_LT(cost, 0.8 * chain_cost(problem, poses_of(problem.keyframes)));
  }
}

TEST(Dual, DistributesOneScalarLoopAnalytically) {
  // Straight along x, translation only, equal weights: each of n steps gets gap / (n + ratio).
  Problem problem = along_x({0, 1, 2, 3, 4});
  // The closure measures 5 m instead of 4 m, with half the information of a step.
  problem.closures.push_back({0, 4, at_x(5.0), 0.5 * Matrix6::Identity()});
  Report report;
  const Trajectory out = Dual({}).correct(problem, report);
  for (int i = 0; i <= 4; ++i) {  // variances: 4 steps of 1 and a closure of 2, so 1/6 m each
    EXPECT_NEAR(out[std::size_t(i)].world_from_body.translation.x(), i + i / 6.0, 1e-9);
  }
  ASSERT_EQ(report.counts.size(), 4u);
  EXPECT_NEAR(report.counts[0].value, 0.5, 1e-12);        // chi^2 of the raw gap
  EXPECT_NEAR(report.counts[2].value, 1.0 / 6.0, 1e-12);  // gap^2 / total variance
}

TEST(Dual, ResultDoesNotDependOnTheInitialKeyframes) {
  Problem problem = walk(5, 16, 0.05);
  const Trajectory a = corrected<Dual>(problem, {.max_iterations = 100, .tolerance = 0.0});
  std::mt19937_64 random(1);
  for (std::size_t i = 1; i < problem.keyframes.size(); ++i) {
    Pose& pose = problem.keyframes[i].world_from_body;
    pose = pose * exp_se3(random_twist(random, 0.1, 0.1));
  }
  expect_close(a, corrected<Dual>(problem, {.max_iterations = 100, .tolerance = 0.0}), 1e-6);
}

TEST(Dual, DeclinesIncompleteChainsAndTooManyLoops) {
  Problem problem = walk(1, 14, 0.05);
  EXPECT_EQ(Dual({}).why_declined(problem), "");
  EXPECT_EQ(Dual({.max_closures = 2}).why_declined(problem),
            "3 closures exceed max_closures = 2: use pose_graph");
  problem.odometry.pop_back();
  EXPECT_EQ(Dual({}).why_declined(problem), "odometry has 12 edges, a complete chain has 13");
  problem.closures.clear();
  EXPECT_EQ(Dual({}).why_declined(problem), "the problem has no loop closures");
}

}  // namespace
}  // namespace loopbench::test::dual_test
