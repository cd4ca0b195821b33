/// Power and negative control: gain of motion_drift on data from its own model, compared with
/// theory, and its loss on data without drift.
#include <gtest/gtest.h>

#include "datasets/noise/random.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/support/corrected.hpp"

namespace loopbench::motion_drift_power_test {

using namespace methods;

namespace {

constexpr MotionDrift::Values kNone{0.0, 0.0, 0.0, 0.0, 0.0};

/// A straight walk along x with the given steps and errors of the steps, and one closure from start
/// to end.
Problem walk_along_x(const std::vector<double>& steps, const std::vector<double>& errors) {
  Problem out;
  double measured = 0.0;
  double truth = 0.0;
  out.keyframes.push_back({0.0, {Rotation::Identity(), Vector3::Zero()}});
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double step = steps[i] + errors[i];
    measured += step;
    truth += steps[i];
    out.keyframes.push_back(
        {static_cast<double>(i + 1), {Rotation::Identity(), Vector3(measured, 0, 0)}});
    out.odometry.push_back({i, i + 1, {Rotation::Identity(), Vector3(step, 0, 0)}});
  }
  Matrix6 precise = Matrix6::Identity() * 1e10;
  out.closures.push_back({0, steps.size(), {Rotation::Identity(), Vector3(truth, 0, 0)}, precise});
  return out;
}

/// Mean over keyframes of the squared error along x, given the true steps.
double mean_square(const Trajectory& estimate, const std::vector<double>& steps) {
  double truth = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    truth += steps[i];
    const double error = estimate[i + 1].world_from_body.translation.x() - truth;
    sum += error * error / static_cast<double>(steps.size());
  }
  return sum;
}

/// Mean square errors of motion_drift and of dual over 300 walks, with the errors of the steps
/// drawn by `draw`.
template <class Draw>
std::pair<double, double> mean_squares(const MotionDrift::Options& options,
                                       const std::vector<double>& steps,
                                       Draw draw) {
  std::pair<double, double> out{0.0, 0.0};
  constexpr int kSeeds = 300;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random({seed}, Purpose::odometry);
    const Problem problem = walk_along_x(steps, draw(random));
    out.first += mean_square(test::corrected<MotionDrift>(problem, options), steps) / kSeeds;
    out.second += mean_square(test::corrected<Dual>(problem), steps) / kSeeds;
  }
  return out;
}

/// 12 slow steps and 6 fast steps.
std::vector<double> slow_and_fast() {
  std::vector<double> out(12, 0.2);
  out.insert(out.end(), 6, 3.0);
  return out;
}

TEST(MotionDriftPower, NoiseByDistanceReachesTheTheoreticalGain) {
  // Variance 0.01 per metre, s(m) accumulated up to keyframe m, S in total. Distributed by s, the
  // remaining error has the variance s (S - s) / S; distributed evenly, with u = m / n, (s - u S)^2
  // / S is added.
  const std::vector<double> steps = slow_and_fast();
  const double total = 0.01 * (12 * 0.2 + 6 * 3.0);
  double best = 0.0;
  double even = 0.0;
  double s = 0.0;
  for (std::size_t m = 1; m <= 18; ++m) {
    s += 0.01 * steps[m - 1];
    const double u = static_cast<double>(m) / 18.0;
    best += s * (total - s) / total / 18.0;
    even += (s * (total - s) + (s - u * total) * (s - u * total)) / total / 18.0;
  }
  MotionDrift::Options options{.fit = false};
  options.drift[1] = kNone;
  options.noise[0] = {0.0, 0.0, 0.01, 0.0, 0.0};
  options.noise[1] = {0.0, 1e-6, 0.0, 0.0, 0.0};
  options.closures = {1.0, 1.0};
  const auto [ours, dual] = mean_squares(options, steps, [&](Random& random) {
    std::vector<double> errors;
    for (const double step : steps) errors.push_back(random.normal3().x() * 0.1 * std::sqrt(step));
    return errors;
  });
  EXPECT_NEAR(ours, best, 0.12 * best);
  EXPECT_NEAR(dual, even, 0.12 * even);
  EXPECT_NEAR(even / best, 2.5, 0.5);
}

TEST(MotionDriftPower, SteadyDriftReachesTheTheoreticalGain) {
  // Twelve seconds at 0.2 m/s, six at 3 m/s; a drift with a known deviation of 1 cm per metre and
  // white noise of 0.0001 m^2/s. The posterior covariance at the keyframes is P - p p' / p_n, where
  // P is the prior covariance; distributed evenly, with u = m / n, it is (I - u e_n') P (I - u
  // e_n')'.
  const std::vector<double> steps = slow_and_fast();
  Eigen::MatrixXd P(18, 18);
  std::vector<double> metres;
  for (const double step : steps) metres.push_back((metres.empty() ? 0.0 : metres.back()) + step);
  for (Eigen::Index a = 0; a < 18; ++a) {
    for (Eigen::Index b = 0; b < 18; ++b) {
      P(a, b) = 1e-4 * metres[static_cast<std::size_t>(a)] * metres[static_cast<std::size_t>(b)] +
                1e-4 * static_cast<double>(std::min(a, b) + 1);
    }
  }
  const Eigen::VectorXd end = P.col(17);
  const double best = (P - end * end.transpose() / end[17]).trace() / 18.0;
  Eigen::MatrixXd evenly = Eigen::MatrixXd::Identity(18, 18);
  evenly.col(17) -= Eigen::VectorXd::LinSpaced(18, 1.0, 18.0) / 18.0;
  const double even = (evenly * P * evenly.transpose()).trace() / 18.0;

  MotionDrift::Options options{.fit = false};
  options.drift[1] = kNone;
  options.noise[0] = {0.0, 1e-4, 0.0, 0.0, 0.0};
  options.noise[1] = {0.0, 1e-6, 0.0, 0.0, 0.0};
  options.drift[0][2] = 0.01;
  options.closures = {1.0, 1.0};
  const auto [ours, dual] = mean_squares(options, steps, [&](Random& random) {
    const double rate = 0.01 * random.normal3().x();
    std::vector<double> errors;
    for (const double step : steps) errors.push_back(rate * step + 0.01 * random.normal3().x());
    return errors;
  });
  EXPECT_NEAR(ours, best, 0.12 * best);
  EXPECT_NEAR(dual, even, 0.2 * even);  // one rate per walk: few degrees of freedom
  EXPECT_GT(even / best, 3.0);
}

/// Two laps of a planar circle of radius 20 m with 40 keyframes each; closures in the second lap.
/// Rotation has white noise and a drift of `drift` [rad/m].
struct Laps {
  Trajectory truth;
  Problem problem;
};

Laps laps(int seed, double drift) {
  Random random({seed}, Purpose::odometry);
  Laps out;
  const double step = 2.0 * std::numbers::pi / 40.0;
  const Pose true_step{exp_so3({0, 0, step}), Vector3(20.0 * step, 0, 0)};
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << Vector3::Constant(1.0 / 4e-4), Vector3::Constant(1.0 / 4e-6);
  Pose pose;
  out.truth.push_back({0.0, pose});
  out.problem.planar = true;
  out.problem.keyframes.push_back({0.0, pose});
  for (std::size_t i = 0; i < 80; ++i) {
    const Vector3 offset = 0.02 * random.normal3();
    const double yaw_error = 0.002 * random.normal3().z() + drift * 20.0 * step;
    const Pose measured =
        normalized(true_step * exp_se3(twist({offset.x(), offset.y(), 0}, {0, 0, yaw_error})));
    const auto stamp = static_cast<double>(i + 1);
    out.truth.push_back({stamp, normalized(out.truth.back().world_from_body * true_step)});
    out.problem.keyframes.push_back(
        {stamp, normalized(out.problem.keyframes.back().world_from_body * measured)});
    out.problem.odometry.push_back({i, i + 1, measured, information});
  }
  for (const std::size_t to : {45u, 60u, 75u}) {
    const Pose exact = out.truth[to - 40].world_from_body.inverse() * out.truth[to].world_from_body;
    const Vector3 offset = 0.01 * random.normal3();
    const double yaw_error = 0.001 * random.normal3().z();
    out.problem.closures.push_back(
        {to - 40,
         to,
         normalized(exact * exp_se3(twist({offset.x(), offset.y(), 0}, {0, 0, yaw_error}))),
         Matrix6::Identity() * 1e4});
    out.problem.closures.back().information.bottomRightCorner<3, 3>() *= 100.0;
  }
  return out;
}

/// Geometric mean over seeds of the error relative to that of `dual`.
double against_dual(const MotionDrift::Options& options, double drift, int seeds) {
  double sum = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Laps data = laps(seed, drift);
    sum += std::log(test::rmse(test::corrected<MotionDrift>(data.problem, options), data.truth) /
                    test::rmse(test::corrected<Dual>(data.problem), data.truth));
  }
  return std::exp(sum / seeds);
}

TEST(MotionDriftPower, EstimatedVariancesGainNearlyAsMuchAsTrueOnes) {
  const double drift = 6e-4;
  MotionDrift::Options true_values{.fit = false};
  true_values.drift[1] = kNone;
  true_values.noise[0] = {0.0, 4e-4, 0.0, 0.0, 0.0};
  true_values.noise[1] = {0.0, 4e-6, 0.0, 0.0, 0.0};
  true_values.drift[1][2] = drift;
  true_values.closures = {1.0, 1.0};
  const double best = against_dual(true_values, drift, 16);
  EXPECT_LT(best, 0.75);
  EXPECT_LT(against_dual({}, drift, 16), 1.1 * best);
}

TEST(MotionDriftPower, WithoutDriftTheLossIsNegligible) {
  EXPECT_LT(against_dual({}, 0.0, 24), 1.02);
}

}  // namespace
}  // namespace loopbench::motion_drift_power_test
