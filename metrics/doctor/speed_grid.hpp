/// Speeds of a trajectory over about one second, on a regular grid of times.
#pragma once

#include <Eigen/Core>

#include "datasets/core/trajectory.hpp"

namespace loopbench::metrics {

/// Values on a grid, with zeros where they are unknown.
struct GridSignal {
  Eigen::ArrayXd value;   ///< without its mean
  Eigen::ArrayXd square;  ///< of `value`
  Eigen::ArrayXd mask;    ///< 1: known, 0: unknown

  /// Removes the mean of the known values, and limits outliers, as jumps of poses cause.
  GridSignal(const Eigen::ArrayXd& values, Eigen::ArrayXd known);

  /// Means of `count` neighbours, known if most of them are.
  GridSignal coarser(Eigen::Index count) const;
};

/// Correlation of two signals over the points that both know.
struct Correlated {
  double value = 0.0;   ///< Pearson's; 0 for constants
  double points = 0.0;  ///< common ones
};

/// Of point i + lag of the first signal with point i of the second. O(points).
Correlated correlation_at(const GridSignal& a, const GridSignal& b, Eigen::Index lag);

/// Number of neighbouring points after which the products of two signals are independent
/// (Bartlett): the sum of the products of their autocorrelations. O(points^2).
double correlated_points(const GridSignal& a, const GridSignal& b);

struct SpeedGrid {
  double begin = 0.0;   ///< time of the first point [s]
  double step = 1.0;    ///< [s]
  GridSignal distance;  ///< linear speed [m/s]
  GridSignal angle;     ///< angular speed [rad/s]; unknown without rotations
};

inline constexpr Eigen::Index kWindowSteps = 8;  ///< of the grid, over which speeds are taken

/// Between the means of the poses in two neighbouring windows of kWindowSteps: noise of single
/// poses, and its reduction by interpolation, hardly change them. Poses are interpolated in gaps of
/// at most `max_gap` [s]. O(points log n).
SpeedGrid speed_grid(const Trajectory& poses, double step, double max_gap);

}  // namespace loopbench::metrics
