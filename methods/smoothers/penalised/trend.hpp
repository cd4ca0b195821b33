/// L1 trend filtering of points in time: a polyline with few kinks. The dual problem is solved by
/// an interior-point method in about 30 Newton steps for any data size.
#pragma once

#include <vector>

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

}  // namespace loopbench::methods
