/// L1 trend filtering of points in time: a polyline with few kinks. The dual problem is solved by
/// an interior-point method in about 30 Newton steps for any data size.
#pragma once

#include <vector>

#include "datasets/core/banded.hpp"
#include "datasets/core/so3.hpp"
#include "methods/smoothers/penalised/pentadiagonal.hpp"
#include "methods/smoothers/penalised/slope_change.hpp"

namespace loopbench::methods {

struct TrendDual {
  std::vector<Vector3> forces;     ///< v_j, |v_j| < lambda; the fit is y - D'v
  std::vector<std::size_t> bends;  ///< rows j where D x is nonzero, ascending
  int iterations = 0;              ///< number of Newton steps
  bool converged = false;
};

/// Minimises 1/2 |D'v - y|^2 subject to |v_j| <= lambda, given outer = D D' and bends = D y, by
/// Newton steps on
///
///     t (1/2 v' D D' v - v' D y) - sum log(lambda^2 - |v_j|^2),
///
/// where t grows tenfold after each centring. The Hessian is block pentadiagonal: O(n) per step.
/// The duality gap is at most two per row over t. The solver stops when that bound is below
/// tolerance^2 / 2 |D'v|^2, so that x is within tolerance |y - x| of the optimum, when rounding
/// prevents any decrease, or after 300 steps; `converged` then states whether the bound is below
/// 1e-4 |D'v|^2. If no constraint is active the answer is the regression line, which is computed
/// directly. Sources: Kim, Koh, Boyd & Gorinevsky, l1 trend filtering, 2009, section 5 (scalar
/// case); Boyd & Vandenberghe, Convex Optimization, 2004, 11.3 and 11.6 (barrier of a second-order
/// cone).
TrendDual solve_trend_dual(const Pentadiagonal& outer,
                           const std::vector<Vector3>& bends,
                           double lambda,
                           double tolerance);

/// Minimises 1/2 sum |y_i - x_i|^2 + lambda sum_j |(D x)_j|, where D is defined in slope_change.hpp
/// and the norm is Euclidean over all three axes (group lasso: all axes have their kinks at the
/// same stamps, independently of the axes' directions). Solved through its dual
/// (solve_trend_dual()), O(n) per Newton step. The unit of time is the mean interval, so lambda is
/// in [unit of y] times intervals. Source: Kim, Koh, Boyd & Gorinevsky 2009.
class Trend {
 public:
  /// Default distance from the optimum / distance from the data [-].
  static constexpr double kTolerance = 1e-4;

  struct Fit {
    std::vector<Vector3> values;
    std::vector<std::size_t> kinks;  ///< inner points at which the slope changes, ascending
    int iterations = 0;
    bool converged = true;
  };

  /// Requires at least three strictly increasing stamps.
  explicit Trend(const std::vector<double>& stamps);

  double interval() const { return interval_; }  ///< mean interval [s]

  /// Returns max |(D D')^-1 D y|, the smallest lambda for which the fit is the regression line.
  double min_lambda_of_line(const std::vector<Vector3>& y) const;

  Fit fit(const std::vector<Vector3>& y, double lambda, double tolerance = kTolerance) const;

  /// Returns the least-squares polyline with the given kinks, without penalty. O(n).
  std::vector<Vector3> refitted(const std::vector<Vector3>& y,
                                const std::vector<std::size_t>& kinks) const;

  /// Replaces the values of the fit by refitted() and removes kinks at which the slope does not
  /// change.
  void refit(const std::vector<Vector3>& y, Fit& fit) const;

 private:
  std::vector<double> times_;  ///< [mean intervals]
  double interval_;
  SlopeChange slope_change_;
};

inline std::vector<double> to_mean_intervals(std::vector<double> stamps, double interval) {
  const double first = stamps.front();
  for (double& stamp : stamps) stamp = (stamp - first) / interval;
  return stamps;
}

inline Trend::Trend(const std::vector<double>& stamps)
    : interval_((stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1)),
      slope_change_({0.0, 1.0, 2.0}) {
  times_ = to_mean_intervals(stamps, interval_);
  slope_change_ = SlopeChange(times_);
}

inline double Trend::min_lambda_of_line(const std::vector<Vector3>& y) const {
  std::vector<Vector3> dual = slope_change_.of(y);
  PentadiagonalFactor(slope_change_.outer()).solve(dual);
  double out = 0.0;
  for (const Vector3& value : dual) out = std::max(out, value.norm());
  return out;
}

inline Trend::Fit Trend::fit(const std::vector<Vector3>& y, double lambda, double tolerance) const {
  const TrendDual dual =
      solve_trend_dual(slope_change_.outer(), slope_change_.of(y), lambda, tolerance);
  Fit out{y, {}, dual.iterations, dual.converged};
  slope_change_.add_transposed(dual.forces, -1.0, out.values);
  for (const std::size_t row : dual.bends) out.kinks.push_back(row + 1);
  return out;
}

inline std::vector<Vector3> Trend::refitted(const std::vector<Vector3>& y,
                                            const std::vector<std::size_t>& kinks) const {
  std::vector<std::size_t> knots{0};
  knots.insert(knots.end(), kinks.begin(), kinks.end());
  knots.push_back(y.size() - 1);
  BandedSystem<double, Vector3> system(knots.size(), 1);
  const auto share = [&](std::size_t piece, std::size_t i) {
    return (times_[i] - times_[knots[piece]]) / (times_[knots[piece + 1]] - times_[knots[piece]]);
  };
  const auto for_each_point = [&](auto visit) {
    for (std::size_t piece = 0; piece + 1 < knots.size(); ++piece) {
      const bool last = piece + 2 == knots.size();
      for (std::size_t i = knots[piece]; i < knots[piece + 1] + (last ? 1 : 0); ++i) {
        visit(piece, i, share(piece, i));
      }
    }
  };
  for_each_point([&](std::size_t piece, std::size_t i, double u) {
    const Vector3 value = y[i] - y.front();
    const double v = 1.0 - u;
    system.at(piece, piece) += v * v;
    system.at(piece, piece + 1) += v * u;
    system.right(piece) += v * value;
    system.at(piece + 1, piece + 1) += u * u;
    system.at(piece + 1, piece) += v * u;
    system.right(piece + 1) += u * value;
  });
  const std::vector<Vector3> knot_values = system.solve();
  std::vector<Vector3> out(y.size());
  for_each_point([&](std::size_t piece, std::size_t i, double u) {
    out[i] = y.front() + (1.0 - u) * knot_values[piece] + u * knot_values[piece + 1];
  });
  return out;
}

inline void Trend::refit(const std::vector<Vector3>& y, Fit& fit) const {
  fit.values = refitted(y, fit.kinks);
  const std::vector<Vector3> slope_changes = slope_change_.of(fit.values);
  double largest = 0.0;
  for (const Vector3& slope_change : slope_changes)
    largest = std::max(largest, slope_change.norm());
  std::erase_if(fit.kinks, [&](std::size_t kink) {
    return slope_changes[kink - 1].norm() <= 1e-9 * largest;  // zero up to rounding
  });
}

}  // namespace loopbench::methods
