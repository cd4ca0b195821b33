/// Where a window's points lie, so that families can work on centred and scaled coordinates.
#pragma once

#include <algorithm>
#include <span>

#include "methods/smoothers/manifold/frame.hpp"

namespace loopbench::manifold {

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

// The neighbours' joints ask for a curve up to one node past its window, half of the range for the
// shortest one, so poles must stay that far away.
constexpr double kPoleMargin = 0.5;  // [of the range of x]

}  // namespace loopbench::manifold
