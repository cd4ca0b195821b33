/// Gain from removing the high-frequency part of the error.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

enum class Filter { sharp, moving_average };
inline auto choices(Filter) {
  return std::array{std::pair{"sharp", Filter::sharp},
                    std::pair{"moving_average", Filter::moving_average}};
}

struct SmoothingHeadroomOptions {
  double window = 1.0;
  Filter filter = Filter::sharp;
};

template <class Visit>
void fields(SmoothingHeadroomOptions& o, Visit visit) {
  visit("window", o.window, "period below which errors count as removable [s]", GreaterThan{0.0});
  visit("filter", o.filter, "low-pass filter");
}

/// Low-pass filters the position error vectors over time: before and after 3d [m] (statistics of
/// the magnitudes), gain [%] = 100 (1 - rmse after / rmse before). The gain is an upper bound for a
/// smoother that removes only high-frequency error.
///
/// `sharp` removes exactly the periods below `window`. The error is interpolated
/// linearly on an even grid at least twice as dense as the poses, so `before` is ate weighted by
/// time, and gaps are bridged linearly. `moving_average` models a simple smoother of that width: it
/// also removes part of the lower frequencies, so its gain is larger. A drift has (nearly)
/// no gain under either. Poses more than half a window apart hide the high-frequency error:
/// evaluate densely. Throws Undefined if the error is zero or all poses have one stamp. O(n log n).
std::vector<Score> smoothing_headroom(const Evaluation& evaluation,
                                      const SmoothingHeadroomOptions& options);

}  // namespace loopbench::metrics
