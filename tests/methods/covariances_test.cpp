// Covariances that methods state: by hand, against dense inverses, and against errors.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "methods/smoothers/gaussian_process.hpp"
#include "methods/solvers/graph_covariance.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/noisy_paths.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::covariances_test {
namespace {

using Covariances = std::vector<Matrix6>;

Covariances of_dual(const Problem& problem, Trajectory* solved = nullptr) {
  Report report;
  const Dual::Options options{.max_iterations = 1000, .tolerance = 0.0, .covariances = true};
  Trajectory poses = corrected<Dual>(problem, options, &report);
  if (solved != nullptr) *solved = std::move(poses);
  return report.covariances;
}

Covariances of_graph(const Problem& problem,
                     Trajectory* solved = nullptr,
                     PoseGraphOptimizer::Options options = {}) {
  Report report;
  options.covariances = true;
  Trajectory poses = corrected<PoseGraphOptimizer>(problem, options, &report);
  if (solved != nullptr) *solved = std::move(poses);
  return report.covariances;
}

/// Expects equal covariances up to `tolerance` times the product of both deviations.
void expect_equal(const Covariances& a, const Covariances& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        EXPECT_NEAR(a[i](r, c), b[i](r, c), tolerance * std::sqrt(b[i](r, r) * b[i](c, c)))
            << i << " " << r << " " << c;
      }
    }
  }
}

/// The pose moved by [d; phi] in fixed axes.
Pose displaced_pose(const Pose& pose, const Twist& by) {
  const Vector3 phi = by.tail<3>();
  return normalized(Pose{exp_so3(phi) * pose.rotation, pose.translation + by.head<3>()});
}

/// Diagonal blocks of the dense inverse of the information, with numeric derivatives of all errors
/// about [d; phi] in fixed axes. `axes` of each pose are free, of the poses from `first` on.
Covariances dense(const Problem& problem,
                  const std::vector<Pose>& poses,
                  const std::vector<Eigen::Index>& axes,
                  std::size_t first = 1) {
  const auto n = static_cast<Eigen::Index>(axes.size());
  const auto size = static_cast<Eigen::Index>(6 * poses.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](const std::vector<std::size_t>& ends,
                       const Eigen::MatrixXd& information,
                       const auto& error) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(information.rows(), size);
    for (const std::size_t end : ends) {
      for (int axis = 0; axis < 6; ++axis) {
        const auto at = [&](double step) -> Eigen::VectorXd {
          std::vector<Pose> moved = poses;
          moved[end] = displaced_pose(poses[end], step * Twist::Unit(axis));
          return error(moved);
        };
        J.col(static_cast<Eigen::Index>(6 * end) + axis) = (at(1e-5) - at(-1e-5)) / 2e-5;
      }
    }
    H += J.transpose() * information * J;
  };
  std::vector<Edge> edges = problem.odometry;
  edges.insert(edges.end(), problem.closures.begin(), problem.closures.end());
  for (const Edge& edge : edges) {
    add({edge.from, edge.to}, edge.information, [&](const std::vector<Pose>& x) {
      return Eigen::VectorXd(edge_error(edge, x[edge.from], x[edge.to]));
    });
  }
  for (const Anchor& anchor : problem.anchors) {
    add({anchor.keyframe}, anchor.covariance.inverse(), [&](const std::vector<Pose>& x) {
      return Eigen::VectorXd(anchor_error(anchor, x[anchor.keyframe]));
    });
  }
  std::vector<Eigen::Index> free;
  for (std::size_t i = first; i < poses.size(); ++i) {
    for (const Eigen::Index axis : axes) free.push_back(static_cast<Eigen::Index>(6 * i) + axis);
  }
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(H(free, free)).inverse();
  Covariances out(poses.size(), Matrix6::Zero());
  for (std::size_t i = first; i < poses.size(); ++i) {
    const auto begin = static_cast<Eigen::Index>(i - first) * n;
    out[i](axes, axes) = inverse.block(begin, begin, n, n);
  }
  return out;
}

const std::vector<Eigen::Index> kSpace{0, 1, 2, 3, 4, 5};
const std::vector<Eigen::Index> kPlane{0, 1, 5};

/// Expects the dense inverse at the solution of `dual`, by both methods.
void expect_dense(const Problem& problem,
                  const std::vector<Eigen::Index>& axes,
                  double tolerance,
                  std::size_t first = 1) {
  Trajectory solved;
  const Covariances dual = of_dual(problem, &solved);
  const Covariances expected = dense(problem, poses_of(solved), axes, first);
  expect_equal(dual, expected, tolerance);
  expect_equal(of_graph(problem), expected, tolerance);
}

// Steps of variance 1 and a closure of variance 1 over four of them: a Brownian bridge, i - i^2 / 5
// along the path. Across it, rotations of variance 1 move later positions.
TEST(Covariances, OfOneLoopWorkedByHand) {
  Problem problem = along_x({0.0, 1.0, 2.0, 3.0, 4.0});
  problem.closures = {{0, 4, at_x(4.0)}};
  for (const Covariances& found : {of_dual(problem), of_graph(problem)}) {
    ASSERT_EQ(found.size(), 5U);
    EXPECT_TRUE(found[0].isZero(0.0));
    const double expected[] = {0.0, 0.8, 1.2, 1.2, 0.8};
    for (std::size_t i = 1; i < 5; ++i) {
      EXPECT_NEAR(found[i](0, 0), expected[i], 1e-12) << i;  // x
      EXPECT_NEAR(found[i](3, 3), expected[i], 1e-12) << i;  // rotation about x
      EXPECT_GT(found[i](1, 1), expected[i]) << i;
    }
  }
}

TEST(Covariances, OfChainsEqualTheDenseInverse) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Pose elsewhere{exp_so3({0.4, -0.8, 1.1}), {30.0, -20.0, 5.0}};
    expect_dense(moved_by(elsewhere, walk(seed, 14, 0.05)), kSpace, 1e-6);
  }
}

TEST(Covariances, InThePlaneHaveNoOtherErrors) {
  Problem problem = moved_by(turned_about_z(0.7, {5.0, -3.0, 0.0}), planar());
  expect_dense(problem, kPlane, 1e-6);
  for (Edge& edge : problem.odometry) {  // correlated with errors that are zero
    Matrix6& information = edge.information;
    information(0, 2) = information(2, 0) = 0.8 * std::sqrt(information(0, 0) * information(2, 2));
    information(4, 5) = information(5, 4) = 0.8 * std::sqrt(information(4, 4) * information(5, 5));
  }
  expect_dense(problem, kPlane, 1e-6);
}

TEST(Covariances, OfAGraphThatIsNoChain) {
  const Pairs closures{{0, 9}, {3, 14}, {1, 16}, {8, 18}, {5, 20}, {2, 21}, {0, 23}, {13, 24}};
  Problem problem = with_closures(walk(7, 25, 0.02), walk(7, 25, 0.0).keyframes, closures);
  problem.odometry.erase(problem.odometry.begin() + 5);  // closures connect both parts
  Trajectory solved;
  const Covariances graph = of_graph(problem, &solved);
  expect_equal(graph, dense(problem, poses_of(solved), kSpace), 1e-6);
}

TEST(Covariances, WithAnchorsIncludeTheFirstPose) {
  const Problem problem = with_anchors(hand_held(), {0.02, -0.01, 0.03});
  expect_dense(problem, kSpace, 1e-5, 0);
  EXPECT_GT(of_graph(problem).front()(0, 0), 0.0);
  const Problem flat = with_anchors(planar(), {0.02, -0.01, 0.0});
  expect_equal(of_dual(flat), of_graph(flat), 1e-5);
}

// Graduated non-convexity gives the false closure no weight.
TEST(Covariances, IgnoreRejectedClosures) {
  Problem problem = walk(5, 30, 0.01);
  const Covariances right = of_graph(problem);
  Edge wrong = problem.closures.back();
  wrong.from += 3;
  wrong.from_from_to.translation.x() += 40.0;
  problem.closures.push_back(wrong);
  expect_equal(of_graph(problem, nullptr, {.gnc = Gnc::tls}), right, 1e-3);
  expect_equal(of_graph(problem, nullptr, {.loss = RobustLoss::dcs}), right, 0.05);
}

TEST(Covariances, AreOptional) {
  Report report;
  corrected<Dual>(hand_held(), {}, &report);
  corrected<PoseGraphOptimizer>(hand_held(), {}, &report);
  EXPECT_TRUE(report.covariances.empty());
}

// Errors of the edges are drawn from their covariances. The coverage of 400 draws has a deviation
// of 1.1 %.
TEST(Covariances, CoverErrorsAsStatedIfAndOnlyIfTheModelIsRight) {
  constexpr int kSeeds = 400;
  const Problem exact = walk(11, 16, 0.0);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const Trajectory& truth = exact.keyframes;
  constexpr std::size_t kMiddle = 9;
  double covered = 0.0;
  double covered_by_half = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Problem problem = exact;
    for (auto* edges : {&problem.odometry, &problem.closures}) {
      for (Edge& edge : *edges) {
        const Pose from_from_to =
            truth[edge.from].world_from_body.inverse() * truth[edge.to].world_from_body;
        edge.information *= 400.0;
        Twist white;
        for (double& each : white) each = normal(random);
        const Twist error = edge.information.llt().matrixU().solve(white);
        edge.from_from_to = normalized(from_from_to * exp_se3(error));
      }
    }
    Trajectory solved;
    const Covariances stated = of_dual(problem, &solved);
    const Pose& found = solved[kMiddle].world_from_body;
    const Pose& right = truth[kMiddle].world_from_body;
    const Twist error = twist(right.translation - found.translation,
                              log_so3(right.rotation * found.rotation.conjugate()));
    const double square = error.dot(stated[kMiddle].llt().solve(error));
    constexpr double kRegion = 12.591587243743977;  // 95 % of chi-squared with 6 degrees
    covered += square <= kRegion ? 100.0 / kSeeds : 0.0;
    covered_by_half += 4.0 * square <= kRegion ? 100.0 / kSeeds : 0.0;
  }
  EXPECT_NEAR(covered, 95.0, 3.3);
  EXPECT_LT(covered_by_half, 60.0);
}

// Without rotation, the process is linear: states [x; v] of each axis, links of white noise on
// acceleration, and measured positions.
TEST(GaussianProcess, StatesTheCovariancesOfItsLinearPosterior) {
  const std::vector<double> times = uneven(20);
  const double sigma = 0.1, power = 0.5;
  const Problem problem{.keyframes = sampled_at(times, [](double t) {
                          return Pose{Rotation::Identity(), {std::sin(t), t, 0}};
                        })};
  GaussianProcess::Options options{.sigma_t = sigma, .sigma_r = 1e-3};
  options.power_t = power;
  options.power_r = 1e-6;
  options.covariances = true;
  Report report;
  GaussianProcess(options).smooth(problem, report);
  const auto n = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    H(2 * i, 2 * i) += 1.0 / (sigma * sigma);
    if (i + 1 == n) break;
    const double dt = times[static_cast<std::size_t>(i + 1)] - times[static_cast<std::size_t>(i)];
    Eigen::Matrix2d Q;
    Q << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
    Eigen::Matrix<double, 2, 4> J;
    J << -1.0, -dt, 1.0, 0.0, 0.0, -1.0, 0.0, 1.0;
    H.block<4, 4>(2 * i, 2 * i) += J.transpose() * (power * Q).inverse() * J;
  }
  const Eigen::MatrixXd inverse = H.inverse();
  ASSERT_EQ(report.covariances.size(), times.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Matrix6& found = report.covariances[static_cast<std::size_t>(i)];
    EXPECT_NEAR(found(0, 0), inverse(2 * i, 2 * i), 1e-3 * inverse(2 * i, 2 * i)) << i;
    EXPECT_NEAR(found(2, 2), found(0, 0), 1e-3 * found(0, 0)) << i;
  }
}

}  // namespace

}  // namespace loopbench::test::covariances_test
