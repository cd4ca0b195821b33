/// Sums over the edges of each loop, and over the edges common to two loops, from one pass over the
/// chain.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Stores running sums only at loop begins and ends, so memory is O(loops) instead of O(edges).
class LoopSums {
 public:
  explicit LoopSums(const std::vector<Edge>& closures) {
    for (const Edge& loop : closures) {
      cuts_.push_back(loop.from);
      cuts_.push_back(loop.to);
    }
    std::ranges::sort(cuts_);
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    for (const Edge& loop : closures) {
      begin_.push_back(index_of(loop.from));
      end_.push_back(index_of(loop.to));
    }
  }

  std::size_t loops() const { return begin_.size(); }
  const std::vector<std::size_t>& cuts() const { return cuts_; }

  /// Sum over the edges of a loop. `running` holds the sum over the edges before each of cuts().
  template <class T>
  T over(const std::vector<T>& running, std::size_t loop) const {
    return running[end_[loop]] - running[begin_[loop]];
  }

  bool overlap(std::size_t k, std::size_t l) const {
    return std::max(begin_[k], begin_[l]) < std::min(end_[k], end_[l]);
  }

  template <class T>
  T over_both(const std::vector<T>& running, std::size_t k, std::size_t l) const {
    return running[std::min(end_[k], end_[l])] - running[std::max(begin_[k], begin_[l])];
  }

 private:
  std::size_t index_of(std::size_t keyframe) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(cuts_, keyframe) - cuts_.begin());
  }

  std::vector<std::size_t> cuts_;   ///< ascending keyframes
  std::vector<std::size_t> begin_;  ///< per loop, an index into cuts_
  std::vector<std::size_t> end_;
};

}  // namespace loopbench::methods
