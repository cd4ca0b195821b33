// The direct least-squares solver of pose graphs: its factorisation, its gradient, and its minima
// compared with those of Ceres.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "methods/solvers/groups/level.hpp"
#include "methods/solvers/groups/se2.hpp"
#include "methods/solvers/groups/se3.hpp"
#include "methods/solvers/normal_equations.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::least_squares_test {

using namespace methods;

namespace {

class Random {
 public:
  double operator()(double size) {
    return std::uniform_real_distribution<double>(-size, size)(engine_);
  }
  int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(engine_); }

 private:
  std::mt19937_64 engine_{5};
};

/// The blocks of the inverse that belong to `pairs`, and those on the diagonal.
template <int D>
void expect_inverts(BlockCholesky<D>& factor,
                    const std::vector<std::pair<int, int>>& pairs,
                    const Eigen::MatrixXd& dense) {
  const Eigen::MatrixXd inverse =
      dense.llt().solve(Eigen::MatrixXd::Identity(dense.rows(), dense.cols()));
  factor.invert();
  const auto expect_block = [&](int i, int j) {
    const Eigen::Matrix<double, D, D> block = factor.inverse_block(factor.location(i, j));
    const Eigen::Matrix<double, D, D> expected = inverse.block<D, D>(i * D, j * D);
    EXPECT_NEAR((block - expected).cwiseAbs().maxCoeff(), 0.0, 1e-11) << i << " " << j;
  };
  for (const auto& [i, j] : pairs) expect_block(i, j), expect_block(j, i), expect_block(j, j);
}

/// A random positive definite matrix with the blocks of `pairs`, by BlockCholesky and dense; then
/// again with a larger diagonal.
template <int D>
void expect_solves(const EliminationStructure& structure,
                   const std::vector<std::pair<int, int>>& pairs) {
  Random random;
  const int blocks = structure.blocks();
  BlockCholesky<D> factor(structure);
  std::vector<std::pair<typename BlockCholesky<D>::Location, Eigen::Matrix<double, D, D>>> added;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(blocks * D, blocks * D);
  const auto add = [&](int i, int j, const Eigen::Matrix<double, D, D>& block) {
    added.emplace_back(factor.location(i, j), block);
    dense.block<D, D>(i * D, j * D) += block;
    if (i != j) dense.block<D, D>(j * D, i * D) += block.transpose();
  };
  for (const auto& [i, j] : pairs) {
    Eigen::Matrix<double, D, 2 * D> J;
    for (double& entry : J.reshaped()) entry = random(1.0);
    const Eigen::Matrix<double, 2 * D, 2 * D> H = J.transpose() * J;
    add(i, i, H.template topLeftCorner<D, D>());
    add(j, j, H.template bottomRightCorner<D, D>());
    add(i, j, H.template topRightCorner<D, D>());
  }
  for (int i = 0; i < blocks; ++i) add(i, i, Eigen::Matrix<double, D, D>::Identity());
  Eigen::MatrixXd right(blocks * D, 2);
  for (double& entry : right.reshaped()) entry = random(1.0);
  const Eigen::VectorXd second = right.col(1);
  Eigen::VectorXd other = second;
  const Eigen::MatrixXd expected = dense.llt().solve(right);
  const auto assemble = [&] {
    factor.set_zero();
    for (const auto& [location, block] : added) factor.add(location, block);
  };
  assemble();
  ASSERT_TRUE(factor.factorise());
  factor.solve(right);
  EXPECT_NEAR((right - expected).cwiseAbs().maxCoeff(), 0.0, 1e-11) << "D = " << D;
  if constexpr (D == 3 || D == 6) expect_inverts(factor, pairs, dense);

  assemble();
  Eigen::VectorXd diagonal;
  ASSERT_TRUE(factor.solve_damped(0.5, diagonal, other));
  for (int i = 0; i < blocks * D; ++i) {
    const int position = structure.position(i / D) * D + i % D;
    EXPECT_NEAR(diagonal[position], dense(i, i), 1e-12);
  }
  dense.diagonal() *= 1.5;
  EXPECT_NEAR((other - dense.llt().solve(second)).cwiseAbs().maxCoeff(), 0.0, 1e-11) << "D = " << D;
}

TEST(BlockCholesky, SolvesChainsWithLoopsAndCliques) {
  Random random;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 1; i < 60; ++i) pairs.emplace_back(i - 1, i);
  for (int k = 0; k < 25; ++k) {
    const int i = random.below(60);
    pairs.emplace_back(i, (i + 1 + random.below(59)) % 60);
  }
  for (int i = 0; i < 20; ++i) {  // wide enough for the kernels of large supernodes
    for (int j = 0; j < i; ++j) pairs.emplace_back(3 * i, 3 * j);
  }
  const EliminationStructure structure(60, pairs);
  expect_solves<1>(structure, pairs);
  expect_solves<2>(structure, pairs);
  expect_solves<3>(structure, pairs);
  expect_solves<6>(structure, pairs);
  expect_solves<7>(structure, pairs);
}

TEST(BlockCholesky, ReportsThatAMatrixIsNotPositiveDefinite) {
  const EliminationStructure structure(2, {{0, 1}});
  BlockCholesky<1> factor(structure);
  const Eigen::Matrix<double, 1, 1> one = Eigen::Matrix<double, 1, 1>::Identity();
  factor.set_zero();
  factor.add(factor.location(0, 0), one);
  factor.add(factor.location(1, 1), one);
  factor.add(factor.location(1, 0), 2.0 * one);
  EXPECT_FALSE(factor.factorise());
}

/// A loop of noisy edges with random closures, near the identity of its group.
struct Graph {
  std::vector<ScaledPose> poses;
  std::vector<Edge> odometry;
  std::vector<Edge> closures;
  std::vector<double> weights;
  std::vector<Anchor> anchors;
};

Graph random_graph(Group group) {
  constexpr std::size_t kPoses = 40;
  Random random;
  const double height = group == Group::se2 ? 0.0 : 1.0;
  const double tilt = group == Group::se2 || group == Group::level ? 0.0 : 1.0;
  const auto motion = [&](double t, double r) {
    return exp_se3(twist({random(t), random(t), height * random(t)},
                         {tilt * random(r), tilt * random(r), random(r)}));
  };
  Graph out;
  std::vector<Pose> truth{Pose{}};
  out.poses.push_back({});
  const auto edge = [&](std::size_t i, std::size_t j) {
    Edge noisy{i, j, truth[i].inverse() * truth[j] * motion(0.1, 0.05)};
    Matrix6 A;
    for (double& entry : A.reshaped()) entry = random(3.0);
    noisy.information = A.transpose() * A + Matrix6::Identity();
    if (group == Group::sim3) noisy.scale = std::exp(random(0.02));
    return noisy;
  };
  for (std::size_t i = 1; i < kPoses; ++i) {
    truth.push_back(truth.back() * motion(1.0, 0.5));
    out.odometry.push_back(edge(i - 1, i));
    out.poses.push_back({truth.back() * motion(0.2, 0.1)});
  }
  for (std::size_t i = 0; i + 12 < kPoses; i += 5) {
    out.closures.push_back(edge(i, i + 12));
    out.weights.push_back(i == 5 ? 0.0 : 0.5);
  }
  for (const std::size_t i : {0UL, 9UL, 20UL, 33UL}) {
    Matrix3 A;
    for (double& entry : A.reshaped()) entry = random(1.0);
    out.anchors.push_back({i,
                           truth[i] * Vector3(0.1, 0.2, 0.0),
                           A.transpose() * A + 0.1 * Matrix3::Identity(),
                           Vector3(0.1, 0.2, 0.0)});
  }
  return out;
}

void expect_the_minimum_of_ceres(Group group, bool has_anchors, bool is_first_free) {
  const Graph graph = random_graph(group);
  PoseGraphSettings settings{.group = group};
  if (has_anchors) settings.anchors = graph.anchors;
  settings.is_first_free = is_first_free;
  EliminationCache cache;
  const auto solve = [&](std::vector<ScaledPose>& poses) {
    return solve_pose_graph(
        poses, {graph.odometry, graph.closures, graph.weights}, settings, cache);
  };
  std::vector<ScaledPose> direct = graph.poses, repeated = graph.poses, ceres = graph.poses;
  const PoseGraphSummary summary = solve(direct);
  solve(repeated);
  settings.loss = RobustLoss::huber;  // solved by Ceres; without effect at this width
  settings.loss_width = 1e15;
  const PoseGraphSummary by_ceres = solve(ceres);
  EXPECT_TRUE(summary.converged);
  EXPECT_NEAR(summary.cost_before, by_ceres.cost_before, 1e-9 * by_ceres.cost_before);
  EXPECT_NEAR(summary.cost, by_ceres.cost, 1e-9 * by_ceres.cost);
  EXPECT_LE(summary.iterations, by_ceres.iterations + 2);
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_POSE_NEAR(direct[i].pose, ceres[i].pose, 1e-6, 1e-6) << i;
    EXPECT_NEAR(direct[i].scale, ceres[i].scale, 1e-6) << i;
    EXPECT_EQ(direct[i].pose.translation, repeated[i].pose.translation) << i;
  }
}

TEST(LeastSquares, ReachesTheMinimumOfCeres) {
  for (const Group group : {Group::se2, Group::se3, Group::sim3, Group::level}) {
    SCOPED_TRACE(static_cast<int>(group));
    expect_the_minimum_of_ceres(group, false, false);
    if (group == Group::sim3) continue;  // has no anchors
    expect_the_minimum_of_ceres(group, true, false);
    expect_the_minimum_of_ceres(group, true, true);
  }
}

/// By definition of the step d = -H^-1 g, the cost changes along it by g' d = -2 predicted
/// decrease.
template <class G>
void expect_slope(Group group) {
  const Graph graph = random_graph(group);
  EliminationCache cache;
  NormalEquations<G> equations(graph.poses.size(),
                               {graph.odometry, graph.closures, graph.weights},
                               {.anchors = graph.anchors, .is_first_free = true},
                               cache);
  std::vector<typename G::Element> x;
  for (const ScaledPose& pose : graph.poses) x.push_back(G::from(pose));
  const double cost = equations.linearise(x);
  EXPECT_DOUBLE_EQ(cost, equations.cost(x));
  typename NormalEquations<G>::Step step;
  ASSERT_TRUE(equations.solve(0.0, step));
  const auto cost_along = [&](double h) {
    auto moved = x;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i) * G::kDof;
      moved[i] = G::compose(x[i], G::exp(h * step.values.template block<G::kDof, 1>(row, 0)));
    }
    return equations.cost(moved);
  };
  constexpr double h = 1e-5;
  const double slope = (cost_along(h) - cost_along(-h)) / (2.0 * h);
  EXPECT_NEAR(slope, -2.0 * step.predicted_decrease, 1e-6 * std::abs(slope));
}

TEST(LeastSquares, PredictsTheDecreaseAlongItsStep) {
  expect_slope<Se2>(Group::se2);
  expect_slope<Se3>(Group::se3);
  expect_slope<Level>(Group::level);
}

}  // namespace
}  // namespace loopbench::least_squares_test
