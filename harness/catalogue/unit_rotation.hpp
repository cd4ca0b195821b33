/// Quaternions from memory, under the rule of the readers of files (formats/pose_rules.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "datasets/core/so3.hpp"

namespace loopbench::harness {

/// Normalises a quaternion unless it is unit up to rounding, and raises `off_unit` to | |q| - 1 |.
/// Throws std::runtime_error with `name` if the norm differs from 1 by more than 1e-2.
inline Rotation unit_rotation(Rotation given, const std::string& name, double& off_unit) {
  constexpr double kTolerance = 1e-2;
  constexpr double kRounding = 4e-15;
  const double square = given.squaredNorm();
  if (std::abs(square - 1.0) <= kRounding) return given;
  const double norm = std::sqrt(square);
  if (!(std::abs(norm - 1.0) <= kTolerance)) {
    throw std::runtime_error(name + ": quaternion has norm " + std::to_string(norm) +
                             ", expected 1 +- 0.01");
  }
  off_unit = std::max(off_unit, std::abs(norm - 1.0));
  given.coeffs() /= norm;
  return given;
}

}  // namespace loopbench::harness
