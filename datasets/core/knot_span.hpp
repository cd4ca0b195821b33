/// Finds the interval of sorted stamps that contains a time; caches the last interval.
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace loopbench {

/// Sorted queries cost O(n + m) in total, unsorted ones O(log n) each.
class KnotSpan {
 public:
  explicit KnotSpan(const std::vector<double>& stamps) : stamps_(stamps) {}

  /// Returns the largest i with stamps[i] <= time, limited to size - 2 so that i + 1 exists (if
  /// size > 1). Throws std::out_of_range if the time is NaN or outside the stamps.
  std::size_t find(double time) {
    if (stamps_.empty() || !(time >= stamps_.front() && time <= stamps_.back())) {
      throw std::out_of_range("time " + std::to_string(time) + " s is outside the curve");
    }
    if (stamps_.size() < 2) return 0;
    if (!holds(last_, time)) {
      if (last_ + 2 < stamps_.size() && holds(last_ + 1, time)) {
        ++last_;
      } else {
        const auto above = std::upper_bound(stamps_.begin(), stamps_.end(), time);
        const auto index = static_cast<std::size_t>(above - stamps_.begin());
        last_ = std::min(index - 1, stamps_.size() - 2);
      }
    }
    return last_;
  }

 private:
  bool holds(std::size_t i, double time) const {
    const bool is_last = i + 2 == stamps_.size();
    return stamps_[i] <= time && (time < stamps_[i + 1] || is_last);
  }

  const std::vector<double>& stamps_;
  std::size_t last_ = 0;
};

}  // namespace loopbench
