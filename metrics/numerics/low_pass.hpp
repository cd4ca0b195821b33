/// A vector series in time without what is faster than a given period.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Values at increasing times.
struct Series {
  std::vector<double> times;  ///< [s]
  std::vector<Vector3> values;
};

/// Joined by straight lines and read at the middles of `cells` equal parts of its span. At least
/// two times. O(n + cells).
Series resampled(const Series& series, std::size_t cells);

/// Sharp: everything of a period below `window` is gone, everything else stays, orthogonal to it.
/// Mirrored at both ends (a cosine transform), so a drift does not tear there. Evenly spaced, a
/// power of two of them. O(n log n).
std::vector<Vector3> without_fast(const Series& even, double window);

/// Centred moving average over `window`; at the ends and beside holes longer than the window it
/// shrinks to stay centred. Of an oscillation of period T it leaves sin(pi window / T) /
/// (pi window / T): nothing at T = window, but only 64 % at 2 windows and 90 % at 4. O(n).
std::vector<Vector3> moving_average(const Series& series, double window);

}  // namespace loopbench
