/// Linear systems with `band` block diagonals on each side of the main one, solved in O(n band^2).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "datasets/core/tridiagonal.hpp"

namespace loopbench::methods {

/// `Block` is double or Matrix3, `Value` the type of the right side. Elimination without pivoting:
/// backward stable for the totally positive matrices of B-spline interpolation (de Boor & Pinkus
/// 1977). The cumulative spline on SO(3) adds only small terms while its steps are small.
template <class Block, class Value>
class BlockBanded {
 public:
  BlockBanded(std::size_t size, std::size_t band, const Block& zero, const Value& right)
      : size_(size), band_(band), blocks_(size * (2 * band + 1), zero), right_(size, right) {}

  /// Requires |row - column| <= band.
  Block& at(std::size_t row, std::size_t column) {
    return blocks_[row * (2 * band_ + 1) + column + band_ - row];
  }
  Value& right(std::size_t row) { return right_[row]; }

  /// Solves the system and overwrites the matrix.
  std::vector<Value> solve() {
    for (std::size_t i = 0; i < size_; ++i) {
      const Block pivot = inverse(at(i, i));
      const std::size_t last = std::min(i + band_, size_ - 1);
      for (std::size_t j = i + 1; j <= last; ++j) {
        const Block factor = at(j, i) * pivot;
        for (std::size_t k = i + 1; k <= last; ++k) at(j, k) -= factor * at(i, k);
        right_[j] -= factor * right_[i];
      }
      at(i, i) = pivot;
    }
    for (std::size_t i = size_; i-- > 0;) {
      for (std::size_t k = i + 1; k <= std::min(i + band_, size_ - 1); ++k) {
        right_[i] -= at(i, k) * right_[k];
      }
      right_[i] = at(i, i) * right_[i];
    }
    return std::move(right_);
  }

 private:
  std::size_t size_;
  std::size_t band_;
  std::vector<Block> blocks_;
  std::vector<Value> right_;
};

}  // namespace loopbench::methods
