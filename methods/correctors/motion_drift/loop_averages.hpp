/// Weighted averages over the loops of a chain, used to scale the prior of the noise model.
#pragma once

#include <Eigen/Core>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench::methods {

/// Weighted means over the loop closures. Closure k has the weight 1 / (s + g)^2, the inverse
/// variance of a squared gap, where s is its stated variance and g the lower median of the squared
/// gaps. Equal variances give equal weights; a closure whose variance is much larger than the gaps
/// has almost no weight; a closure whose variance is much smaller counts no more than the others.
/// Translation and rotation are weighted separately.
///
/// The motion of a loop is at least the chain's mean motion per second times the loop's duration: a
/// loop closed while the vehicle is at rest does not determine an error per metre or per radian.
class LoopAverages {
 public:
  /// `gap` holds six numbers per closure. O(closures log closures + edges).
  LoopAverages(const Problem& problem,
               const std::vector<EdgeMotion>& motions,
               const Eigen::VectorXd& gap);

  /// Mean squared gap per axis [m^2], [rad^2].
  double gap(Component component) const { return means_[index(component)].gap; }

  /// Mean stated variance of the closures per axis [m^2], [rad^2].
  double stated(Component component) const { return means_[index(component)].stated; }

  /// Mean over the loops of the (optionally squared) motion accumulated along a loop. O(edges +
  /// closures).
  double motion(Component component, Regressor regressor, bool squared) const;

  /// Mean over the loops of the stated odometry variance per axis accumulated along a loop [m^2],
  /// [rad^2]. O(edges + closures).
  double stated_odometry(Component component) const;

 private:
  struct Means {
    double gap = 0.0;
    double stated = 0.0;
    std::vector<double> weights;  ///< one per closure, normalised to a sum of 1
  };
  static std::size_t index(Component component) { return static_cast<std::size_t>(component); }
  Means means_of(Component component, const Eigen::VectorXd& gap) const;
  template <class Of>
  double mean_along_loops(Component component, bool squared, Of of) const;

  const Problem& problem_;
  const std::vector<EdgeMotion>& motions_;
  Means means_[2];
};

}  // namespace loopbench::methods
