/// The cubic through four points of a path, for derivatives that do not care about even spacing.
#pragma once

#include <array>
#include <cstddef>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Newton's coefficients of the cubic with p(offsets[k]) = points[k]; c[3] is a sixth of its third
/// derivative. Offsets [s] must differ. They are what the clock really said: stamps of 1e9 s
/// come in steps of 2.4e-7 s, and differences of neighbours are exact.
inline std::array<Vector3, 4> divided_differences(const std::array<double, 4>& offsets,
                                                  std::array<Vector3, 4> points) {
  for (std::size_t order = 1; order < 4; ++order) {
    for (std::size_t k = 3; k >= order; --k) {
      points[k] = (points[k] - points[k - 1]) / (offsets[k] - offsets[k - order]);
    }
  }
  return points;
}

}  // namespace loopbench
