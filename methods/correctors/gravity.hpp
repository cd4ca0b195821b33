/// Roll and pitch held as measured, for odometry with gravity (visual-inertial odometry).
#pragma once

#include <string>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// A problem in which each keyframe is levelled: its rotation is Rz(yaw) T with the z axis of the
/// world, which must be vertical, and T (roll and pitch) is constant. Its poses are then those of
/// group `level`, with yaw and position free, as in VINS.
///
/// Edges are expressed between the levelled bodies. They lose the roll and pitch that contradicts
/// the keyframes; if their information couples these with the other components, those move by the
/// conditional mean. Source: Qin, Li, Shen, VINS-Mono, T-RO 2018, section VII C.
class LevelledProblem {
 public:
  /// O(keyframes + edges + anchors).
  explicit LevelledProblem(const Problem& problem);

  const Problem& problem() const { return levelled_; }

  /// The keyframes with their roll and pitch. O(keyframes).
  Trajectory tilted(Trajectory levelled) const;

  /// Adds the count `tilt_error` [deg], rms over the closures of the roll and pitch in which they
  /// differ from the keyframes, and a note if that contradicts their deviations.
  void report_tilt(Report& report) const;

 private:
  Edge levelled(const Edge& edge, Eigen::Vector2d& tilt) const;

  std::vector<Rotation> tilts_;  ///< T of each keyframe
  Problem levelled_;
  double squared_tilt_ = 0.0;    ///< of the closures, summed [rad^2]
  double squared_stated_ = 0.0;  ///< its expected value
  double chi2_ = 0.0;            ///< of their roll and pitch
};

/// Why roll and pitch cannot be held; empty if they can.
std::string gravity_fault(const Problem& problem);

}  // namespace loopbench::methods
