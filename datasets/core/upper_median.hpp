/// Median of a list that may be reordered.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace loopbench {

/// The middle value; the upper one of two for an even count. Reorders `values`, which is not empty.
/// O(n).
template <class T>
T upper_median(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace loopbench
