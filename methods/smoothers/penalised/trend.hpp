/// L1 trend filtering of points in time: a polyline with few bends.
#pragma once

#include <vector>

#include "methods/smoothers/penalised/slope_change.hpp"

namespace loopbench {

/// Minimises 1/2 sum |y_i - x_i|^2 + lambda sum_j |(D x)_j| with D from slope_change.hpp and the
/// Euclidean norm of all three axes together (a group: the axes bend in the same place, wherever
/// they point), through its dual (trend_dual.hpp). O(n) a Newton step.
/// Time runs in mean intervals, so lambda is in [unit of y] times intervals.
/// Source: Kim, Koh, Boyd & Gorinevsky 2009.
class Trend {
 public:
  struct Settings {
    double tolerance = 1e-4;  ///< distance from the optimum over that from the data [-]
    int most = 300;           ///< Newton steps
  };
  struct Fit {
    std::vector<Vector3> values;
    std::vector<std::size_t> kinks;  ///< inner points where the slope changes, ascending
    int iterations = 0;
    bool converged = true;
  };

  /// Three strictly increasing stamps or more.
  explicit Trend(const std::vector<double>& stamps);

  double interval() const { return interval_; }  ///< mean [s]

  /// From this lambda up the answer is the straight line of regression: max |(D D')^-1 D y|.
  double straight_from(const std::vector<Vector3>& y) const;

  Fit fit(const std::vector<Vector3>& y, double lambda, const Settings& settings) const;

  /// Least squares with the kinks given, not pulled towards the straight line. O(n).
  std::vector<Vector3> refitted(const std::vector<Vector3>& y,
                                const std::vector<std::size_t>& kinks) const;

  /// Puts those values into the fit and drops kinks at which they do not bend after all.
  void refit(const std::vector<Vector3>& y, Fit& fit) const;

 private:
  std::vector<double> times_;  ///< [mean intervals]
  double interval_;
  SlopeChange slope_change_;
};

}  // namespace loopbench
