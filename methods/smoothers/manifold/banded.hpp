/// Linear systems with `band` diagonals on each side of the main one, solved in O(n band^2).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace loopbench::methods::manifold {

constexpr std::size_t kMaxBand = 5;

/// Elimination without pivoting. It is stable for both uses here: the totally positive matrices of
/// B-spline interpolation (de Boor & Pinkus 1977) and positive definite matrices.
template <class Value>
class Banded {
 public:
  Banded(std::size_t size, std::size_t band, const Value& zero)
      : band_(band), rows_(size, {{}}), right_(size, zero) {}

  double& at(std::size_t row, std::size_t column) { return rows_[row][column + band_ - row]; }
  Value& right(std::size_t row) { return right_[row]; }
  std::size_t size() const { return rows_.size(); }

  /// Solves the system and overwrites the matrix.
  std::vector<Value> solve() {
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = i + 1; j <= std::min(i + band_, size() - 1); ++j) {
        const double factor = at(j, i) / at(i, i);
        if (factor == 0.0) continue;
        for (std::size_t k = i; k <= std::min(i + band_, size() - 1); ++k) {
          at(j, k) -= factor * at(i, k);
        }
        right_[j] -= factor * right_[i];
      }
    }
    for (std::size_t i = size(); i-- > 0;) {
      for (std::size_t k = i + 1; k <= std::min(i + band_, size() - 1); ++k) {
        right_[i] -= at(i, k) * right_[k];
      }
      right_[i] /= at(i, i);
    }
    return std::move(right_);
  }

 private:
  std::size_t band_;
  std::vector<std::array<double, 2 * kMaxBand + 1>> rows_;  ///< initially zero
  std::vector<Value> right_;
};

}  // namespace loopbench::methods::manifold
