/// Natural cubic smoothing spline for one value of lambda, and the symmetric positive definite
/// systems with two diagonals on each side that it leads to. All operations are O(n).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "datasets/core/so3.hpp"

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

/// Slope changes D y of a polyline in time at its inner stamps. Row j of D is (1 / h_j, -1 / h_j -
/// 1 / h_{j+1}, 1 / h_{j+1}) on the values j..j+2, where h are the intervals. D has n - 2 rows for
/// n >= 3 stamps. D' is Reinsch's Q.
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

/// Minimises sum |y_i - f(t_i)|^2 + lambda int |f''|^2. With Q = D' (SlopeChange) and R the
/// tridiagonal Gram matrix of the hat functions,
///
///     (R + lambda Q'Q) gamma = Q'y,   f(t_i) = y_i - lambda (Q gamma)_i,   f''(t_i) = gamma_i.
///
/// lambda -> 0 interpolates, lambda -> infinity gives the regression line. O(n).
/// Source: Reinsch 1967; Green & Silverman 1994, ch. 2; Hutchinson & de Hoog 1985 for the trace.
class Reinsch {
 public:
  struct Fit {
    std::vector<Vector3> values;      ///< f at the stamps
    std::vector<Vector3> curvatures;  ///< f'' at the stamps, zero at both ends
    double residual_dof = 0.0;        ///< tr(I - A), residual degrees of freedom per axis
    Vector3 residual;                 ///< y' (I - A)^2 y per axis
    Vector3 energy;                   ///< y' (I - A) y per axis
    double log_determinant = 0.0;     ///< of I - A on its range, up to a constant of the stamps
  };

  /// Requires at least three strictly increasing stamps.
  explicit Reinsch(const std::vector<double>& stamps);

  /// Fits y with lambda > 0 [s^3]. A is the matrix with values = A y.
  Fit fit(const std::vector<Vector3>& y, double lambda) const;

 private:
  SlopeChange slope_change_;
  Pentadiagonal gram_;   ///< R
  Pentadiagonal outer_;  ///< Q'Q
};

/// Selection criterion of lambda.
enum class Criterion {
  gcv,   ///< n |(I - A) y|^2 / tr(I - A)^2 (Craven & Wahba 1979)
  reml,  ///< restricted maximum likelihood: (n - 2) log y'(I - A)y - log det+ (I - A) (Wahba 1985)
};
inline auto choices(Criterion) {
  return std::array{std::pair{"gcv", Criterion::gcv}, std::pair{"reml", Criterion::reml}};
}

/// Returns the value of the criterion for a fit to n keyframes, over all axes; lower is better.
double score(Criterion criterion, const Reinsch::Fit& fit, std::size_t n);

/// Returns the best lambda [s^3] on the lattice (mean interval)^3 * 10^(k / 8), 1e-6 to 1e12. A
/// lattice makes the choice independent of rounding. About 35 fits.
double select_lambda(const Reinsch& reinsch,
                     const std::vector<double>& stamps,
                     const std::vector<Vector3>& y,
                     Criterion criterion);

/// Smallest lambda [s^3] of that lattice, which interpolates.
double interpolating_lambda(const std::vector<double>& stamps);

}  // namespace loopbench::methods
