/// Median without sorting.
#pragma once

#include <span>

namespace loopbench::metrics {

/// Mean of the middle two for an even count. The list is not empty and holds no NaN. O(n): one pass
/// keeps the values near the median of a sample, then selects among them; if the sample is not
/// representative, selects among all values.
double median(std::span<const double> values);

}  // namespace loopbench::metrics
