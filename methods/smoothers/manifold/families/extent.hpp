/// Bounding box of a window's points, for centring and scaling their coordinates.
#pragma once

#include <algorithm>
#include <span>

#include "methods/smoothers/manifold/frame.hpp"

namespace loopbench::methods::manifold {

struct Extent {
  Vector2 low, high;  ///< [m]

  explicit Extent(std::span<const Vector2> points) : low(points.front()), high(points.front()) {
    for (const Vector2& point : points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
  }
  Vector2 centre() const { return 0.5 * (low + high); }
  Vector2 size() const { return high - low; }
};

// Joints evaluate a curve up to one node past its window, which is half of the range for the
// shortest window, so poles must be at least that far away.
constexpr double kPoleMargin = 0.5;  // fraction of the range of x

}  // namespace loopbench::methods::manifold
