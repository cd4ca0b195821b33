/// L1 trend filtering of points in time: a polyline with few kinks.
#pragma once

#include <vector>

#include "methods/smoothers/penalised/slope_change.hpp"

namespace loopbench::methods {

/// Minimises 1/2 sum |y_i - x_i|^2 + lambda sum_j |(D x)_j|, where D is defined in slope_change.hpp
/// and the norm is Euclidean over all three axes (group lasso: all axes have their kinks at the
/// same stamps, independently of the axes' directions). Solved through its dual (trend_dual.hpp),
/// O(n) per Newton step. The unit of time is the mean interval, so lambda is in [unit of y] times
/// intervals. Source: Kim, Koh, Boyd & Gorinevsky 2009.
class Trend {
 public:
  struct Settings {
    double tolerance = 1e-4;  ///< distance from the optimum / distance from the data [-]
    int most = 300;           ///< maximum number of Newton steps
  };
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

  Fit fit(const std::vector<Vector3>& y, double lambda, const Settings& settings) const;

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
