// Paths with known noise, and the error of a smoother's curve with respect to the true path.
#pragma once

#include <random>

#include "methods/method.hpp"
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

/// White noise with standard deviation sigma on positions [m] and sigma / 10 on rotations [rad].
inline Trajectory with_white_noise(Trajectory keyframes, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  const auto any = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  for (auto& [stamp, pose] : keyframes) {
    pose.translation += any();
    pose.rotation = (pose.rotation * exp_so3(0.1 * any())).normalized();
  }
  return keyframes;
}

inline double rms_error(const Curve& curve, const Trajectory& truth) {
  double sum = 0.0;
  for (const auto& [stamp, pose] : truth) {
    sum += (curve.at(stamp).translation - pose.translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

template <class T>
std::unique_ptr<const Curve> smooth(const Trajectory& keyframes,
                                    const Params& params = {},
                                    Report* report = nullptr) {
  Report own;
  Problem problem;
  problem.keyframes = keyframes;
  return T(with(typename T::Options{}, params)).smooth(problem, report ? *report : own);
}

}  // namespace loopbench::test
