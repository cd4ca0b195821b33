/// What to believe of an error model before the loops are looked at closely.
#pragma once

#include <Eigen/Core>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench {

/// How large errors are thought to be, for terms that are not given. [-]
struct Guess {
  double noise_part;      ///< of the way: translation noise gathered over a loop
  double drift_part;      ///< of the way: steady translation drift
  double rotation_noise;  ///< of the loops' squared turning gaps: due to noise, the rest to drift
};

/// Fills the values of terms that are not given. Translation errors are a part of the way, so that
/// the unit of length, unknown to a monocular camera, does not matter; rotation errors are judged
/// by the turning gaps, which odometry makes. Terms of one cause and half get equal parts.
///
/// Closures keep their stated covariance unless it is vaguer than both what it states of odometry
/// bears and a tenth of the gap it closes: some files state units of their own.
///
/// `gap` holds the closures' gaps when no edge is corrected, six numbers a closure.
/// O(edges terms + closures).
void guess(MotionModel& model,
           const Guess& by,
           const Problem& problem,
           const std::vector<EdgeMotion>& motions,
           const Eigen::VectorXd& gap);

}  // namespace loopbench
