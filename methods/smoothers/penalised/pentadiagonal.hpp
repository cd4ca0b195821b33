/// Symmetric positive definite systems with two diagonals on each side. All operations are O(n).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace loopbench::methods {

/// One column from the diagonal down: entries (i, i), (i + 1, i), (i + 2, i). Entries below the
/// last row are zero.
struct Band {
  double diagonal = 0.0, next = 0.0, second = 0.0;
};
using Pentadiagonal = std::vector<Band>;

/// Factorisation M = L D L', where L is unit lower triangular with two subdiagonals. No pivoting:
/// stable for positive definite M.
class PentadiagonalFactor {
 public:
  explicit PentadiagonalFactor(Pentadiagonal matrix) : columns_(std::move(matrix)) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      Band& c = columns_[i];
      const double d = c.diagonal, below = c.next, far = c.second;
      c.next /= d;
      c.second /= d;
      if (i + 1 < columns_.size()) {
        columns_[i + 1].diagonal -= c.next * below;
        columns_[i + 1].next -= c.second * below;
      }
      if (i + 2 < columns_.size()) columns_[i + 2].diagonal -= c.second * far;
    }
  }

  /// Computes M^-1 right in place.
  template <class Value>
  void solve(std::vector<Value>& right) const {
    const std::size_t n = columns_.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) right[i] -= columns_[i - 1].next * right[i - 1];
      if (i > 1) right[i] -= columns_[i - 2].second * right[i - 2];
    }
    for (std::size_t i = n; i-- > 0;) {
      right[i] /= columns_[i].diagonal;
      if (i + 1 < n) right[i] -= columns_[i].next * right[i + 1];
      if (i + 2 < n) right[i] -= columns_[i].second * right[i + 2];
    }
  }

  double log_determinant() const {
    double sum = 0.0;
    for (const Band& c : columns_) sum += std::log(c.diagonal);
    return sum;
  }

  /// Returns the five central diagonals of M^-1 (Hutchinson & de Hoog 1985).
  Pentadiagonal inverse_bands() const {
    Pentadiagonal out(columns_.size());
    Band below, far;  // columns i + 1 and i + 2 of the inverse
    for (std::size_t i = columns_.size(); i-- > 0;) {
      const Band& c = columns_[i];
      Band& column = out[i];
      column.next = -c.next * below.diagonal - c.second * below.next;
      column.second = -c.next * below.next - c.second * far.diagonal;
      column.diagonal = 1.0 / c.diagonal - c.next * column.next - c.second * column.second;
      far = below;
      below = column;
    }
    return out;
  }

 private:
  std::vector<Band> columns_;  ///< D on the diagonal, L below
};

/// Returns tr(A B) of two symmetric matrices, of which at least one is pentadiagonal. The other is
/// given by its central bands.
inline double trace_of_product(const Pentadiagonal& a, const Pentadiagonal& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i].diagonal * b[i].diagonal;
    sum += 2.0 * (a[i].next * b[i].next + a[i].second * b[i].second);
  }
  return sum;
}

}  // namespace loopbench::methods
