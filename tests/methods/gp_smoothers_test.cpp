// gp_wnoa: evidence and posterior.
#include <gtest/gtest.h>

#include <random>

#include "methods/smoothers/gaussian_process.hpp"
#include "methods/smoothers/gp/posterior.hpp"
#include "methods/smoothers/smoothing_spline.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/noisy_paths.hpp"

namespace loopbench::gp_smoothers_test {

using namespace methods;

namespace {

using namespace test;

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
}  // namespace loopbench::gp_smoothers_test
