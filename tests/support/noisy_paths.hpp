// Paths with known noise, smoothers on keyframes, and properties of their curves.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "methods/method.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test {

using namespace methods;

inline const std::vector<double> kTwelve{
    0.0, 0.3, 0.5, 1.1, 1.3, 2.0, 2.2, 2.9, 3.1, 3.5, 4.2, 4.4};

inline std::vector<Vector3> wavy(const std::vector<double>& stamps) {
  std::vector<Vector3> out;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double s = stamps[i];
    const double noise = 0.1 * std::sin(37.0 * static_cast<double>(i));
    out.push_back(Vector3(std::sin(s), 0.5 * s, std::cos(2.0 * s)) + noise * Vector3(1, -2, 0.5));
  }
  return out;
}

/// White noise with standard deviation sigma on positions [m], and on rotations `ratio` times as
/// many [rad].
inline Trajectory with_white_noise(Trajectory keyframes,
                                   double sigma,
                                   std::uint64_t seed,
                                   double ratio = 0.1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  const auto any = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  for (auto& [stamp, pose] : keyframes) {
    pose.translation += any();
    pose.rotation = (pose.rotation * exp_so3(ratio * any())).normalized();
  }
  return keyframes;
}

inline double rms_error(const Curve& curve, const Trajectory& truth) {
  return rmse(curve.sample(stamps(truth)), truth);
}

/// Expects the poses of the path `truth` ten times per interval.
template <class Truth>
void expect_follows(const Curve& curve,
                    const Trajectory& keyframes,
                    Truth truth,
                    double tolerance) {
  const std::vector<double> times = query_times(keyframes, 9);
  expect_close(curve.sample(times), sampled_at(times, truth), tolerance);
}

template <class T>
std::unique_ptr<const Curve> smooth(const Trajectory& keyframes,
                                    const Params& params = {},
                                    Report* report = nullptr) {
  Report own;
  const Problem problem{.keyframes = keyframes};
  const T smoother(with(typename T::Options{}, params));
  EXPECT_EQ(smoother.why_declined(problem), "");
  auto curve = smoother.smooth(problem, report ? *report : own);
  EXPECT_TRUE(own.notes.empty());
  return curve;
}

/// Expects equal velocities and angular velocities on both sides of every inner keyframe.
inline void expect_no_kink(const Curve& curve, const Trajectory& keyframes) {
  constexpr double h = 1e-5;
  for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
    const double t = keyframes[i].stamp;
    const Pose current = curve.at(t);
    const auto rate = [&](double side) {
      const Pose other = curve.at(t + side);
      return Twist(twist(other.translation - current.translation,
                         log_so3(current.rotation.conjugate() * other.rotation)) /
                   side);
    };
    EXPECT_LT((rate(h) - rate(-h)).norm(), 1e-3) << i;
  }
}

}  // namespace loopbench::test
