/// Cubic through four points of a path, for derivatives at unevenly spaced times.
#pragma once

#include <array>
#include <cstddef>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// Newton's coefficients of the cubic with p(offsets[k]) = points[k]; c[3] is a sixth of its third
/// derivative. Offsets [s] must differ. Use the offsets of the rounded stamps: stamps near 1e9 s
/// have a resolution of 2.4e-7 s, and differences of neighbouring stamps are exact.
inline std::array<Vector3, 4> divided_differences(const std::array<double, 4>& offsets,
                                                  std::array<Vector3, 4> points) {
  for (std::size_t order = 1; order < 4; ++order) {
    for (std::size_t k = 3; k >= order; --k) {
      points[k] = (points[k] - points[k - 1]) / (offsets[k] - offsets[k - order]);
    }
  }
  return points;
}

}  // namespace loopbench::metrics
