// gp_wnoa: body rates, the prior between two states, its Jacobians, evidence and posterior.
#include "methods/smoothers/gaussian_process.hpp"

#include <gtest/gtest.h>

#include <random>

#include "methods/smoothers/gp/link.hpp"
#include "methods/smoothers/gp/posterior.hpp"
#include "methods/smoothers/smoothing_spline.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/noisy_paths.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::test::gaussian_process_test {
namespace {

TEST(BodyRate, SeriesEqualsTheInverseRightJacobian) {
  std::mt19937_64 random(1);
  // The series is replaced by the closed form at 1.414.
  for (const double angle : {0.0, 1e-8, 1e-3, 0.3, 1.4, 1.414, 1.415, 2.0, 3.1}) {
    Twist xi = random_twist(random, 2.0, 1.0);
    xi.tail<3>() *= angle / xi.tail<3>().norm();
    const BodyRateTerms c(xi.tail<3>().squaredNorm());
    const Matrix6 ad = small_adjoint(xi);
    const Matrix6 J = Matrix6::Identity() + 0.5 * ad + c.c2 * ad * ad + c.c4 * ad * ad * ad * ad;
    EXPECT_NEAR((J - inverse_right_jacobian_se3(xi)).norm(), 0.0, 1e-11) << angle;
  }
}

TEST(BodyRate, DerivativeAgreesWithDifferences) {
  std::mt19937_64 random(2);
  for (const double angle : {0.0, 1e-3, 0.3, 1.4, 1.43, 2.5, 3.1}) {
    Twist xi = random_twist(random, 2.0, 1.0);
    xi.tail<3>() *= angle / xi.tail<3>().norm();
    const Twist v = random_twist(random, 1.0, 1.0);
    const Matrix6 analytic = body_rate_jacobian(xi, v);
    constexpr double step = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Twist d = step * Twist::Unit(k);
      const Twist numeric =
          (inverse_right_jacobian_se3(xi + d) * v - inverse_right_jacobian_se3(xi - d) * v) /
          (2.0 * step);
      EXPECT_NEAR((numeric - analytic.col(k)).norm(), 0.0, 1e-8) << angle << ", " << k;
    }
  }
}

GpState random_state(std::mt19937_64& random) {
  GpState out;
  out.pose = exp_se3(random_twist(random, 1.0, 0.8));
  out.rate = random_twist(random, 1.0, 0.5);
  return out;
}

GpState moved(GpState state, const GpVector& by) {
  state.pose = state.pose * exp_se3(by.head<6>());
  state.rate += by.tail<6>();
  return state;
}

TEST(Link, JacobiansAgreeWithDifferences) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const GpState from = random_state(random), to = random_state(random);
    const Link analytic = link(from, to, 1.7);
    constexpr double step = 1e-6;
    for (int k = 0; k < 12; ++k) {
      const GpVector d = step * GpVector::Unit(k);
      const GpVector by_from =
          (link(moved(from, d), to, 1.7).error - link(moved(from, -d), to, 1.7).error) /
          (2.0 * step);
      const GpVector by_to =
          (link(from, moved(to, d), 1.7).error - link(from, moved(to, -d), 1.7).error) /
          (2.0 * step);
      const double size = analytic.by_from.norm();
      EXPECT_NEAR((by_from - analytic.by_from.col(k)).norm(), 0.0, 1e-8 * size) << k;
      EXPECT_NEAR((by_to - analytic.by_to.col(k)).norm(), 0.0, 1e-8 * size) << k;
    }
  }
}

TEST(Link, IsWhiteForUnitPower) {
  // Without rotation the error is linear: the covariance of W e must be the identity for e ~ Q(h).
  const double h = 1.7;
  Eigen::Matrix2d Q;  // textbook covariance for constant velocity
  Q << std::pow(h, 3) / 3, h * h / 2, h * h / 2, h;
  Eigen::Matrix2d W;
  GpState from;
  from.rate.setZero();
  for (int b = 0; b < 2; ++b) {
    GpVector d = GpVector::Zero();
    d[6 * b] = 1.0;
    const GpVector error = link(from, moved(from, d), h).error;
    for (int a = 0; a < 2; ++a) W(a, b) = error[6 * a];
  }
  EXPECT_NEAR((W * Q * W.transpose() - Eigen::Matrix2d::Identity()).norm(), 0.0, 1e-12);
}

TEST(Prior, BetweenTwoStatesConstantVelocityIsTheHermiteCubic) {
  for (const double s : {0.0, 0.2, 0.7, 1.0}) {
    const auto weights = Prior::between(s);
    EXPECT_NEAR(weights.from[0], 1.0 - 3.0 * s * s + 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.from[1], s - 2.0 * s * s + s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[0], 3.0 * s * s - 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[1], s * s * s - s * s, 1e-14);
  }
}

TEST(GaussianProcess, ReproducesAConstantTwistExactly) {
  // A helix at constant speed: the driving noise is zero.
  const Pose start{exp_so3({0.3, 0.1, -1.0}), {5.0, -2.0, 1.0}};
  const auto truth = [&](double time) {
    return start * exp_se3(time * twist({0.8, 0.1, 0.2}, {0.1, -0.2, 0.7}));
  };
  const Trajectory keyframes = sampled_at(uneven(15), truth);
  const auto curve = smooth<GaussianProcess>(keyframes);
  expect_follows(*curve, keyframes, truth, 1e-9);
}

/// A wave without rotation and with position noise `sigma` [m].
Trajectory wave(std::size_t n, double sigma) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, sigma);
  Trajectory out;
  for (const double s : uneven(n)) {
    const Vector3 noise(normal(random), normal(random), normal(random));
    out.push_back({s, {Rotation::Identity(), Vector3(std::sin(s), s, std::cos(s)) + noise}});
  }
  return out;
}

TEST(GaussianProcess, WithoutRotationIsTheSmoothingSpline) {
  const Trajectory keyframes = wave(25, 0.03);
  // lambda = sigma^2 / power; rotations are fixed.
  const auto process = smooth<GaussianProcess>(
      keyframes, {{"sigma_t", 0.1}, {"sigma_r", 1e-7}, {"power_t", 0.5}, {"power_r", 1e-12}});
  const auto spline = smooth<SmoothingSpline>(keyframes, {{"lambda_t", 0.02}});
  for (double time = 0.0; time < keyframes.back().stamp; time += 0.07) {
    EXPECT_NEAR((process->at(time).translation - spline->at(time).translation).norm(), 0.0, 1e-6)
        << time;
  }
}

/// -log restricted likelihood by dense matrices: V = q K + sigma^2 I, where K(s, t) is the kernel
/// of the once integrated Wiener process and constant and linear terms are free.
double dense_negative_evidence(const Trajectory& keyframes, double sigma, double power) {
  const auto n = static_cast<Eigen::Index>(keyframes.size());
  Eigen::MatrixXd V(n, n), T(n, 2), Y(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& current = keyframes[static_cast<std::size_t>(i)];
    T.row(i) << 1.0, current.stamp;
    Y.row(i) = current.world_from_body.translation;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double s = std::min(current.stamp, keyframes[static_cast<std::size_t>(j)].stamp);
      const double t = std::max(current.stamp, keyframes[static_cast<std::size_t>(j)].stamp);
      V(i, j) = power * s * s * (3.0 * t - s) / 6.0 + (i == j ? sigma * sigma : 0.0);
    }
  }
  const Eigen::MatrixXd Vi = V.inverse();
  const Eigen::MatrixXd TVT = T.transpose() * Vi * T;
  const Eigen::MatrixXd projected = Vi - Vi * T * TVT.inverse() * T.transpose() * Vi;
  const double log_det = std::log(V.determinant()) + std::log(TVT.determinant());
  return 0.5 * (3.0 * log_det + (Y.transpose() * projected * Y).trace());
}

TEST(GaussianProcess, EvidenceAgreesWithTheDenseComputationForTwelvePoses) {
  const Trajectory keyframes = wave(12, 0.03);
  const GpPosterior posterior(keyframes);
  const double unit = std::pow(posterior.interval(), 3);
  const auto both = [&](double sigma, double power) {
    const GpParameters parameters{sigma, 1e-7, power * unit, 1e-12};
    auto states = posterior.initial_states();
    posterior.solve(states, parameters);
    return std::pair{posterior.negative_evidence(states, parameters),
                     dense_negative_evidence(keyframes, sigma, power)};
  };
  const auto [sparse, dense] = both(0.03, 0.5);
  for (const auto& [sigma, power] : {std::pair{0.05, 0.5}, {0.03, 2.0}, {0.01, 0.1}}) {
    const auto [sparse_other, dense_other] = both(sigma, power);
    EXPECT_NEAR(sparse_other - sparse, dense_other - dense, 1e-3) << sigma << ", " << power;
  }
}

TEST(GaussianProcess, EstimatesTheNoiseAndRemovesAThirdOfIt) {
  const Trajectory truth = hand_held_truth(120);
  const Trajectory keyframes = with_white_noise(truth, 0.02, 1, 0.5);
  Report report;
  const auto curve = smooth<GaussianProcess>(keyframes, {}, &report);
  EXPECT_NEAR(count(report, "sigma_t"), 0.02, 0.006);
  EXPECT_NEAR(count(report, "sigma_r"), 0.01, 0.003);
  const Trajectory smoothed = curve->sample(stamps(truth));
  EXPECT_LT(rmse(smoothed, truth), 0.67 * rmse(keyframes, truth));
  const auto rotation_error = [&](const Trajectory& poses) {
    double sum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const Rotation& expected = truth[i].world_from_body.rotation;
      sum += std::pow(angle_between(poses[i].world_from_body.rotation, expected), 2);
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(rotation_error(smoothed), 0.67 * rotation_error(keyframes));
}

TEST(GaussianProcess, HasNoKink) {
  const Trajectory keyframes = with_white_noise(hand_held_truth(20), 0.02, 2, 0.5);
  const auto curve = smooth<GaussianProcess>(keyframes);
  expect_no_kink(*curve, keyframes);
}

}  // namespace
}  // namespace loopbench::test::gaussian_process_test
