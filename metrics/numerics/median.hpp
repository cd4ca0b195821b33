/// The middle of a list, without sorting it.
#pragma once

#include <span>

namespace loopbench {

/// The mean of the middle two for an even count. Not empty, no NaN. O(n): one pass that
/// keeps what lies about the middle of a sample, then a selection among those; where the sample is
/// unlike the rest, a selection among all.
double median(std::span<const double> values);

}  // namespace loopbench
