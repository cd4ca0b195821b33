/// Averages over the loops of a chain, by which the prior of the error model is scaled.
#pragma once

#include <Eigen/Core>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench {

/// Weighted means over the loop closures. A closure has the weight 1 / (s + g)^2, the inverse
/// variance of a squared gap, where s is its own stated variance and g the lower median of the
/// squared gaps. Equal variances give equal weights, a closure much weaker than the gaps has next
/// to none, and one that is much stronger counts no more than the others. Translation and rotation
/// are weighted separately.
///
/// A loop has at least the chain's mean motion times its own duration: one that closes while the
/// vehicle is at rest measures no error per metre or per radian.
class LoopAverages {
 public:
  /// `gap` holds six numbers per closure. O(closures log closures + edges).
  LoopAverages(const Problem& problem,
               const std::vector<EdgeMotion>& motions,
               const Eigen::VectorXd& gap);

  /// Mean squared gap per axis [m^2], [rad^2].
  double gap(Half half) const { return means_[index(half)].gap; }

  /// Mean variance that the closures state per axis [m^2], [rad^2].
  double stated(Half half) const { return means_[index(half)].stated; }

  /// Mean of the motion accumulated along a loop, or of its square. O(edges + closures).
  double motion(Half half, Growth growth, bool squared) const;

  /// Mean of the variance that the odometry edges along a loop state per axis. O(edges + closures).
  double stated_odometry(Half half) const;

 private:
  struct Means {
    double gap = 0.0;
    double stated = 0.0;
    std::vector<double> weights;  ///< one per closure, their sum is 1
  };
  static std::size_t index(Half half) { return static_cast<std::size_t>(half); }
  Means means_of(Half half, const Eigen::VectorXd& gap) const;
  template <class Of>
  double along_loops(Half half, bool squared, Of of) const;

  const Problem& problem_;
  const std::vector<EdgeMotion>& motions_;
  Means means_[2];
};

}  // namespace loopbench
