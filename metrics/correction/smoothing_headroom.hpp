/// How much of the error is fast enough for a smoother to remove?
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

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
  visit("window", o.window, "error of a shorter period counts as removable [s]", Above{0.0});
  visit("filter", o.filter, "what parts slow error from fast");
}

/// The position error vectors as a series in time, and what is left without its fast part:
/// before and after 3d [m] (statistics of the magnitudes), gain [%] = 100 (1 -
/// rmse after / rmse before). What a smoother that takes all fast error away and touches no slow
/// error could have gained at most.
///
/// `sharp` removes every period below `window` and nothing else (low_pass.hpp). The error is joined
/// by straight lines and read on an even grid at least twice as fine as the poses, so `before` is
/// ate weighted by time; a hole counts as a straight line. `moving_average` is what a simple
/// smoother of that width would do to the error: it also takes part of what is slower, so its gain
/// is larger. A steady drift gains (nearly) nothing under either. Poses sparser than half a window
/// hide the fast error: judge densely. Throws Undefined when there is no error, or no
/// time passes. O(n log n).
std::vector<Score> smoothing_headroom(const Evaluation& evaluation,
                                      const SmoothingHeadroomOptions& options);

}  // namespace loopbench
