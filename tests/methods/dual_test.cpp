#include "methods/correctors/dual.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "methods/correctors/chain.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::dual_test {

using namespace methods;

namespace {

using namespace test;

/// Solves a pose graph by dense Gauss-Newton with numeric derivatives.
std::vector<Pose> dense_gauss_newton(const Problem& problem, int iterations) {
  std::vector<Pose> x = poses_of(problem.keyframes);
  std::vector<Edge> edges = problem.odometry;
  edges.insert(edges.end(), problem.closures.begin(), problem.closures.end());
  const auto N = static_cast<Eigen::Index>(6 * (x.size() - 1));  // the first pose is fixed
  for (int it = 0; it < iterations; ++it) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(N, N);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(N);
    for (const Edge& e : edges) {
      Eigen::Matrix<double, 6, 12> J;
      for (int d = 0; d < 12; ++d) {
        const auto moved = [&](double by) {
          Twist t = Twist::Zero();
          t[d % 6] = by;
          return edge_error(e,
                            d < 6 ? x[e.from] * exp_se3(t) : x[e.from],
                            d < 6 ? x[e.to] : x[e.to] * exp_se3(t));
        };
        J.col(d) = (moved(1e-6) - moved(-1e-6)) / 2e-6;
      }
      const Twist error = edge_error(e, x[e.from], x[e.to]);
      const Eigen::Matrix<double, 12, 12> h = J.transpose() * e.information * J;
      const Eigen::Matrix<double, 12, 1> b = J.transpose() * e.information * error;
      const std::size_t ends[] = {e.from, e.to};
      for (int r = 0; r < 2; ++r) {
        if (ends[r] == 0) continue;
        const auto row = static_cast<Eigen::Index>(6 * (ends[r] - 1));
        g.segment<6>(row) += b.segment<6>(6 * r);
        for (int c = 0; c < 2; ++c) {
          if (ends[c] == 0) continue;
          const auto column = static_cast<Eigen::Index>(6 * (ends[c] - 1));
          H.block<6, 6>(row, column) += h.block<6, 6>(6 * r, 6 * c);
        }
      }
    }
    const Eigen::VectorXd step = -H.ldlt().solve(g);
    for (std::size_t i = 1; i < x.size(); ++i) {
      const Twist t = step.segment<6>(static_cast<Eigen::Index>(6 * (i - 1)));
      x[i] = normalized(x[i] * exp_se3(t));
    }
  }
  return x;
}

TEST(Dual, EqualsAPoseGraphSolvedByDenseGaussNewton) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Problem problem = walk(seed, 14, 0.05);
    const Trajectory dual = corrected<Dual>(problem, {.max_iterations = 100, .tolerance = 0.0});
    const std::vector<Pose> reference = dense_gauss_newton(problem, 20);
    for (std::size_t i = 0; i < dual.size(); ++i) {
      EXPECT_TRUE(is_close(dual[i].world_from_body, reference[i], 1e-6, 1e-6)) << seed << " " << i;
    }
    const double cost = chain_cost(problem, poses_of(dual));
    EXPECT_NEAR(cost, chain_cost(problem, reference), 1e-9 * cost);
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
  EXPECT_EQ(Dual({.max_closures = 2}).why_declined(problem), "3 closures exceed max_closures = 2");
  problem.odometry.pop_back();
  EXPECT_EQ(Dual({}).why_declined(problem), "odometry has 12 edges, a complete chain has 13");
  problem.closures.clear();
  EXPECT_EQ(Dual({}).why_declined(problem), "the problem has no loop closures");
}

}  // namespace
}  // namespace loopbench::dual_test
