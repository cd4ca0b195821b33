/// Roll, pitch and yaw errors of many rotations.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"

namespace loopbench::metrics {

/// Magnitudes of the Euler angles of many rotations [deg].
class Rpy {
 public:
  explicit Rpy(std::size_t size) {
    for (std::vector<double>& angle : degrees_) angle.resize(size);
  }

  void set(std::size_t i, const Rotation& rotation) {
    const auto [roll, pitch, yaw] = euler(rotation);
    degrees_[0][i] = kDegrees * std::abs(roll);
    degrees_[1][i] = kDegrees * std::abs(pitch);
    degrees_[2][i] = kDegrees * std::abs(yaw);
  }

  /// rotation roll, pitch, yaw [deg]. Moves the values out; call once.
  std::vector<Score> scores(int ddof) {
    return {{"rotation", "roll", "deg", statistics(std::move(degrees_[0]), ddof)},
            {"rotation", "pitch", "deg", statistics(std::move(degrees_[1]), ddof)},
            {"rotation", "yaw", "deg", statistics(std::move(degrees_[2]), ddof)}};
  }

 private:
  std::array<std::vector<double>, 3> degrees_;
};

}  // namespace loopbench::metrics
