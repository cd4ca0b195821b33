/// Spread of positions.
#pragma once

#include <cmath>
#include <cstddef>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// Standard deviation [m] of `count` > 0 positions: of position(0), position(1), ... O(count).
template <typename Position>
double spread_of(std::size_t count, const Position& position) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t i = 0; i < count; ++i) mean += position(i);
  mean /= static_cast<double>(count);
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) squares += (position(i) - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(count));
}

}  // namespace loopbench::metrics
