/// Random draws that are identical with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include "datasets/core/se3.hpp"
#include "datasets/noise/noise_stream.hpp"

namespace loopbench {

/// Each purpose has its own stream, so that more draws for one do not change the others.
enum class Purpose : std::uint32_t {
  odometry = 1,
  closures = 2,
  false_closures = 3,
  white_noise = 4,
  anchors = 5
};

class Random {
 public:
  Random(const NoiseStream& stream, Purpose purpose) {
    const auto bits = static_cast<std::uint64_t>(stream.seed);
    std::seed_seq sequence{static_cast<std::uint32_t>(bits),
                           static_cast<std::uint32_t>(bits >> 32),
                           static_cast<std::uint32_t>(purpose),
                           static_cast<std::uint32_t>(stream.identity),
                           static_cast<std::uint32_t>(stream.identity >> 32)};
    bits_.seed(sequence);
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

  /// Uniform integer in [0, count).
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }

  /// Three independent standard normal draws; always consumes four words of the stream.
  Vector3 normal3() {
    const auto [a, b] = pair();
    const auto [c, unused] = pair();
    return {a, b, c};
  }

  Twist normal_twist(double sigma_t, double sigma_r) {
    const Vector3 rho = sigma_t * normal3();
    return twist(rho, sigma_r * normal3());
  }

 private:
  /// Two independent standard normal draws (Box and Muller 1958).
  std::pair<double, double> pair() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }

  std::mt19937_64 bits_;
};

}  // namespace loopbench
