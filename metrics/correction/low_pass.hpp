/// Low-pass filters for vector-valued time series.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench::metrics {

/// Values at increasing times.
struct Series {
  std::vector<double> times;  ///< [s]
  std::vector<Vector3> values;
};

/// Interpolates linearly and samples at the midpoints of `cells` equal intervals of the time span.
/// Needs at least two times. O(n + cells).
Series resample(const Series& series, std::size_t cells);

/// Ideal low-pass: removes all periods below `window` and keeps the rest, as an orthogonal
/// projection. The series is mirrored at both ends (cosine transform), so a drift causes no
/// discontinuity there. The samples are evenly spaced; their number is a power of two. O(n log n).
std::vector<Vector3> low_pass(const Series& even, double window);

/// Centred moving average over `window`; it shrinks symmetrically at the ends and next to gaps
/// longer than the window. An oscillation of period T is multiplied by sin(pi window / T) /
/// (pi window / T): 0 at T = window, 64 % at 2 windows and 90 % at 4. O(n).
std::vector<Vector3> moving_average(const Series& series, double window);

}  // namespace loopbench::metrics
