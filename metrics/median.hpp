/// The middle of a list, without sorting it.
#pragma once

#include <span>

namespace loopbench {

/// The mean of the middle two for an even count. Not empty, no NaN. O(n): a pass that counts
/// values by their leading bits, then a selection among those that share the middle's.
double median(std::span<const double> values);

}  // namespace loopbench
