/// Mean, standard deviation, percentiles and spread of positions. (The median is in median.hpp.)
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// Arithmetic mean. Throws std::invalid_argument for an empty list.
inline double mean(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("mean of an empty list");
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Standard deviation with divisor n - 1. Throws std::invalid_argument for fewer than two values.
inline double sample_deviation(std::span<const double> values) {
  if (values.size() < 2) throw std::invalid_argument("standard deviation of fewer than two values");
  const double middle = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// The value at `share` (0..1) of a sorted list that is not empty, interpolated linearly between
/// neighbours (numpy's default).
inline double percentile(const std::vector<double>& sorted, double share) {
  const double rank = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

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
