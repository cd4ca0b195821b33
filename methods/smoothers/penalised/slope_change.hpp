/// Slope changes D y of a polyline in time at its inner stamps.
#pragma once

#include <array>
#include <vector>

#include "datasets/core/so3.hpp"
#include "methods/smoothers/penalised/pentadiagonal.hpp"

namespace loopbench::methods {

/// Row j of D is (1 / h_j, -1 / h_j - 1 / h_{j+1}, 1 / h_{j+1}) on the values j..j+2, where h are
/// the intervals. D has n - 2 rows for n >= 3 stamps. D' is Reinsch's Q.
class SlopeChange {
 public:
  using Row = std::array<double, 3>;

  explicit SlopeChange(const std::vector<double>& stamps) {
    rows_.reserve(stamps.size() - 2);
    for (std::size_t j = 0; j + 2 < stamps.size(); ++j) {
      const double before = 1.0 / (stamps[j + 1] - stamps[j]);
      const double after = 1.0 / (stamps[j + 2] - stamps[j + 1]);
      rows_.push_back({before, -before - after, after});
    }
  }

  std::size_t size() const { return rows_.size(); }

  /// Returns D values.
  std::vector<Vector3> of(const std::vector<Vector3>& values) const {
    std::vector<Vector3> out(rows_.size());
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      // Differences first, to avoid cancellation of large coordinates.
      out[j] =
          rows_[j][2] * (values[j + 2] - values[j + 1]) - rows_[j][0] * (values[j + 1] - values[j]);
    }
    return out;
  }

  /// Adds factor * D' changes to `out`.
  void add_transposed(const std::vector<Vector3>& changes,
                      double factor,
                      std::vector<Vector3>& out) const {
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[j + k] += (factor * rows_[j][k]) * changes[j];
    }
  }

  /// Returns D D', n - 2 rows.
  Pentadiagonal outer() const {
    Pentadiagonal out(rows_.size());
    const auto product = [&](std::size_t i, std::size_t j) {
      double sum = 0.0;
      for (std::size_t k = j; k < i + 3; ++k) sum += rows_[i][k - i] * rows_[j][k - j];
      return sum;
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      out[i].diagonal = product(i, i);
      if (i + 1 < rows_.size()) out[i].next = product(i, i + 1);
      if (i + 2 < rows_.size()) out[i].second = product(i, i + 2);
    }
    return out;
  }

 private:
  std::vector<Row> rows_;
};

}  // namespace loopbench::methods
