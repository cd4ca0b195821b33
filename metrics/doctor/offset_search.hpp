/// Offset of two clocks from the correlation of speeds, at any size.
#pragma once

#include <optional>
#include <vector>

#include "metrics/doctor/speed_grid.hpp"

namespace loopbench::metrics {

/// How well the speeds agree at an offset of the estimate's stamps.
struct OffsetFit {
  double offset = 0.0;      ///< to add to the estimate's stamps [s]
  double deviation = 0.0;   ///< standard deviation [s], from the scatter of twenty parts; the
                            ///< range of the search if that failed
  double distance = 0.0;    ///< correlation of linear speeds
  double angle = 0.0;       ///< of angular speeds; 0 without rotations
  double points = 0.0;      ///< common ones of the grids
  double likelihood = 0.0;  ///< its logarithm, over that of unrelated speeds
};

class OffsetSearch {
 public:
  /// Both have the same step.
  OffsetSearch(SpeedGrid reference, SpeedGrid estimate);

  /// Agreement at an offset, which is rounded to the grid. O(points).
  OffsetFit at(double offset) const;

  /// The fit near zero if it agrees well; otherwise the best fits over all offsets that leave at
  /// least three tenths of the shorter file in common, and over the grid near zero: local maxima
  /// that are apart, the best first; at most three. O(points^2) for 500 points, coarse to fine.
  std::vector<OffsetFit> best() const;

  /// Points of the estimate's grid.
  double size() const { return static_cast<double>(estimate_.distance.mask.size()); }

 private:
  OffsetFit fit_at(const SpeedGrid& reference,
                   const SpeedGrid& estimate,
                   double independent,
                   Eigen::Index lag) const;
  /// Between the points of the grid, with its deviation; nullopt if `start` is at no maximum.
  std::optional<OffsetFit> refined(const OffsetFit& start) const;
  double zero_lag() const { return (estimate_.begin - reference_.begin) / reference_.step; }

  SpeedGrid reference_, estimate_;
  SpeedGrid coarse_reference_, coarse_estimate_;
  double of_distance_ = 1.0, of_angle_ = 1.0;  ///< dependent points of the fine grid
};

}  // namespace loopbench::metrics
