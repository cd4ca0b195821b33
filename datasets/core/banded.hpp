/// Linear systems with `band` (block) diagonals on each side of the main one.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// Matrix of blocks (`Block` is double or Matrix3) and right side of `Value`s, initially zero.
/// Elimination without pivoting, which is backward stable for the matrices used here: totally
/// positive ones of B-spline interpolation (de Boor & Pinkus 1977; the cumulative spline on SO(3)
/// adds only small terms while its steps are small), diagonally dominant and positive definite
/// ones. O(size band^2) time, O(size band) memory.
template <class Block, class Value>
class BandedSystem {
 public:
  BandedSystem(std::size_t size, std::size_t band)
      : band_(band), blocks_(size * (2 * band + 1), zero<Block>()), right_(size, zero<Value>()) {}

  std::size_t size() const { return right_.size(); }

  /// Requires |row - column| <= band.
  Block& at(std::size_t row, std::size_t column) {
    return blocks_[row * (2 * band_ + 1) + column + band_ - row];
  }
  Value& right(std::size_t row) { return right_[row]; }

  /// Solves the system and overwrites it.
  std::vector<Value> solve() {
    for (std::size_t i = 0; i < size(); ++i) {
      const Block pivot = inverse(at(i, i));
      const std::size_t last = std::min(i + band_, size() - 1);
      for (std::size_t k = i + 1; k <= last; ++k) at(i, k) = pivot * at(i, k);
      right_[i] = pivot * right_[i];
      for (std::size_t j = i + 1; j <= last; ++j) {
        const Block& lower = at(j, i);
        for (std::size_t k = i + 1; k <= last; ++k) at(j, k) -= lower * at(i, k);
        right_[j] -= lower * right_[i];
      }
    }
    for (std::size_t i = size(); i-- > 0;) {
      for (std::size_t k = i + 1; k <= std::min(i + band_, size() - 1); ++k) {
        right_[i] -= at(i, k) * right_[k];
      }
    }
    return std::move(right_);
  }

 private:
  template <class T>
  static T zero() {
    if constexpr (std::is_arithmetic_v<T>) {
      return T{0};
    } else {
      return T::Zero();
    }
  }
  static double inverse(double block) { return 1.0 / block; }
  static Matrix3 inverse(const Matrix3& block) { return block.inverse(); }

  std::size_t band_;
  std::vector<Block> blocks_;
  std::vector<Value> right_;
};

}  // namespace loopbench
