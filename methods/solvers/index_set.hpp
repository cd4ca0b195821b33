/// Indices without repetition.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace loopbench::methods {

/// Lists indices in the order of their insertion. O(1) per insertion, O(size of the list) to clear.
class IndexSet {
 public:
  void add_index() { is_in_.push_back(0); }  ///< one more that can be inserted
  void insert(std::size_t index) {
    if (std::exchange(is_in_[index], 1) == 0) list_.push_back(index);
  }
  void clear() {
    for (const std::size_t index : list_) is_in_[index] = 0;
    list_.clear();
  }
  bool contains(std::size_t index) const { return is_in_[index] != 0; }
  const std::vector<std::size_t>& list() const { return list_; }

 private:
  std::vector<char> is_in_;
  std::vector<std::size_t> list_;
};

}  // namespace loopbench::methods
