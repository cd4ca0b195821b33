#include "methods/correctors/consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "methods/correctors/checked.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::consistency_test {
namespace {

/// Steps of 1 m along x with variance 1 on every axis; closures with variance 0.25.
Problem line(const std::vector<std::tuple<std::size_t, std::size_t, double>>& closures) {
  Problem problem = test::along_x({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  for (const auto& [from, to, metres] : closures) {
    problem.closures.push_back({from, to, at_x(metres), 4.0 * Matrix6::Identity()});
  }
  return problem;
}

TEST(Consistency, PairsByHandWhereTheLoopIsShort) {
  // Closures 0 -> 9 and 2 -> 10: the odometry between their ends is 2 steps and 1 step.
  const Problem problem = line({{0, 9, 9.5}, {2, 10, 7.0}});
  const PairError pair = pair_error(problem, problem.closures[0], problem.closures[1]);
  // -9.5 + 2 + 7 - 1 along x; variances 2 * 0.25 + 2 + 1, no rotation.
  EXPECT_NEAR(pair.error[0], -1.5, 1e-12);
  EXPECT_NEAR(pair.covariance(0, 0), 3.5, 1e-12);
  EXPECT_NEAR(pair.covariance(3, 3), 3.5, 1e-12);
}

TEST(Consistency, OdometryInBothDirectionsCancels) {
  // Disjoint loops: odometry 3 -> 6 is traversed in both directions and cancels along x.
  const Problem problem = line({{0, 3, 3.0}, {6, 9, 3.0}});
  const PairError pair = pair_error(problem, problem.closures[0], problem.closures[1]);
  EXPECT_NEAR(pair.error.norm(), 0.0, 1e-12);
  EXPECT_NEAR(pair.covariance(0, 0), 2 * 0.25 + 3 + 3, 1e-12);
}

TEST(Consistency, PropagatedCovarianceMatchesSampledCovariance) {
  const Problem exact = test::walk(3, 20, 0.0);
  Problem problem = exact;
  problem.closures[1].from = 12;  // overlapping and nested loops, odometry in both directions
  problem.closures[1].to = 19;
  const Pose exact_loop =
      problem.keyframes[12].world_from_body.inverse() * problem.keyframes[19].world_from_body;
  problem.closures[1].from_from_to = exact_loop;
  for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges)
      edge.information *= 1e4;  // small noise: the propagation is first order
  }
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const Problem noise_free = problem;
  for (const auto& [k, l] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{2, 1}}) {
    const auto first = static_cast<std::size_t>(k);
    const auto second = static_cast<std::size_t>(l);
    const Matrix6 propagated =
        pair_error(noise_free, noise_free.closures[first], noise_free.closures[second]).covariance;
    Matrix6 drawn = Matrix6::Zero();
    constexpr int kDraws = 500;
    for (int draw = 0; draw < kDraws; ++draw) {
      problem = noise_free;
      for (std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
        for (Edge& edge : *edges) {
          Twist noise;
          for (int i = 0; i < 6; ++i) noise[i] = normal(random);
          const Matrix6 root = Matrix6(edge.information.inverse()).llt().matrixL();
          edge.from_from_to = edge.from_from_to * exp_se3(root * noise);
        }
      }
      const Twist e = pair_error(problem, problem.closures[first], problem.closures[second]).error;
      drawn += e * e.transpose() / kDraws;
    }
    EXPECT_LT((drawn - propagated).norm(), 0.2 * propagated.norm()) << k << " " << l;
  }
}

TEST(Consistency, KeepsTheLargestConsistentSet) {
  // Three closures agree with the odometry, two with each other on a wrong loop, one with none.
  const Problem problem =
      line({{0, 8, 8.0}, {0, 9, 9.1}, {1, 10, 8.9}, {0, 10, 40.0}, {1, 9, 38.1}, {2, 9, -60.0}});
  const ConsistentClosures found = consistent_closures(problem);
  EXPECT_EQ(found.kept, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(found.is_largest);
  // A closure without any consistent partner is dropped, unless it is the only one.
  EXPECT_TRUE(consistent_closures(line({{0, 9, 9.0}, {0, 10, 90.0}})).kept.empty());
  EXPECT_EQ(consistent_closures(line({{0, 9, 90.0}})).kept.size(), 1u);
}

TEST(Consistency, CheckedCorrectorUsesConsistentClosuresOnly) {
  const Problem consistent_only = line({{0, 8, 8.4}, {0, 9, 9.4}, {1, 10, 9.4}});
  Problem problem = consistent_only;
  problem.closures.insert(problem.closures.begin() + 1, {3, 8, at_x(-200.0), Matrix6::Identity()});
  Report report;
  const Trajectory checked = test::corrected<PairwiseConsistent<Dual>>(problem, {}, &report);
  test::expect_close(checked, test::corrected<Dual>(consistent_only), 1e-12);
  EXPECT_EQ(report.counts.front().name, "closures_consistent");
  EXPECT_EQ(report.counts.front().value, 3.0);
  EXPECT_EQ(report.rejected, std::vector<std::size_t>{1});
  PairwiseConsistentOptions<Dual> few;
  few.max_closures = 3;
  EXPECT_EQ(PairwiseConsistent<Dual>(few).why_declined(problem),
            "4 closures exceed pcm.max_closures = 3");
}

TEST(Consistency, OneClosureIsUsedWithANote) {
  Report report;
  test::corrected<PairwiseConsistent<Dual>>(line({{0, 9, -40.0}}), {}, &report);
  EXPECT_EQ(report.rejected, std::vector<std::size_t>{});
  ASSERT_FALSE(report.notes.empty());
  EXPECT_EQ(report.notes.front(), kOneClosure);
}

TEST(Consistency, RejectionsOfTheBaseAreIndicesOfTheWholeProblem) {
  // -200 is inconsistent; the other pairs agree, but their differences sum up.
  Problem problem = line({{3, 8, -200.0}, {0, 9, 9.0}, {0, 10, 10.0}, {1, 10, 9.0}, {1, 9, 16.5}});
  PairwiseConsistentOptions<PoseGraphOptimizer> options;
  options.base.gnc = Gnc::tls;
  Report report;
  test::corrected<PairwiseConsistent<PoseGraphOptimizer>>(problem, options, &report);
  ASSERT_TRUE(report.rejected);
  double kept = -1.0;
  for (const Count& count : report.counts) {
    if (count.name == "closures_kept") kept = count.value;
  }
  EXPECT_EQ(report.rejected->size(), 5 - static_cast<std::size_t>(kept));
  EXPECT_EQ(report.rejected->front(), 0u);
}

TEST(Consistency, CheckedCorrectorDeclinesWhatItsBaseDeclines) {
  PairwiseConsistentOptions<PoseGraphOptimizer> planar;
  planar.base.group = PoseGraphOptimizer::Poses::se2;
  const Problem problem = line({{0, 8, 8.4}, {0, 9, 9.4}});
  ASSERT_FALSE(problem.planar);
  EXPECT_EQ(PairwiseConsistent<PoseGraphOptimizer>(planar).why_declined(problem),
            "group is se2, but the problem is not planar");
}

TEST(Consistency, CheckedCorrectorDeclinesMoreConsistentClosuresThanItsBaseTakes) {
  PairwiseConsistentOptions<Dual> few;
  few.base.max_closures = 1;
  const Problem problem = line({{0, 5, 5.0}, {2, 8, 6.0}});
  EXPECT_EQ(PairwiseConsistent<Dual>(few).why_declined(problem), "");  // known after the check
  EXPECT_THROW(test::corrected<PairwiseConsistent<Dual>>(problem, few), Declined);
}

TEST(MaxClique, FindsAPlantedOneAndProvesIt) {
  std::mt19937_64 random(2);
  std::bernoulli_distribution joined(0.5);
  BitGraph graph(100);
  std::vector<std::size_t> planted;
  for (std::size_t a = 0; a < 100; ++a) {
    if (a % 6 == 0) planted.push_back(a);
    for (std::size_t b = 0; b < a; ++b) {
      if (joined(random) || (a % 6 == 0 && b % 6 == 0)) graph.join(a, b);
    }
  }
  const Clique found = max_clique(graph, 1000000);
  EXPECT_TRUE(found.is_largest);
  EXPECT_EQ(found.members, planted);
  EXPECT_EQ(max_clique(graph, 0).is_largest, false);
  EXPECT_GE(max_clique(graph, 0).members.size(), 8u);  // greedy search only
}

TEST(MaxClique, HandlesEmptyGraphsAndGraphsWithoutEdges) {
  EXPECT_TRUE(max_clique(BitGraph(0), 10).members.empty());
  EXPECT_EQ(max_clique(BitGraph(70), 1000).members.size(), 1u);
}

}  // namespace
}  // namespace loopbench::test::consistency_test
