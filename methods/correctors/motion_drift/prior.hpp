/// What to believe of an error model before the loops are looked at closely.
#pragma once

#include <Eigen/Core>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench {

/// How large errors are thought to be, for terms that are not given, and how far each may be from
/// that. Spreads are standard deviations of logarithms of variances. Learnt on the chains of KITTI
/// 00 and TUM fr1_room (results/methods): there steady drift outweighs noise after 4 s to 5 min.
struct MotionPriorOptions {
  double noise_part = 0.002;   ///< of the way: translation noise gathered over a loop [-]
  double stated_part = 0.33;   ///< of the noise: shaped as the odometry edges state [-]
  double steady_after = 60.0;  ///< loops this long gather as much from drift as from noise [s]
  double scale_spread = 2.3;   ///< of all errors of a half together
  double steady_spread = 1.8;  ///< of steady drift against noise
  double axis_spread = 1.5;    ///< of one body axis' drift against the others'
  double share_spread = 0.7;   ///< of each term beside all that
  double stated_spread = 1.5;  ///< of what the odometry edges state, beside the scale
  double closures_spread = 0.7;
};

/// Independent standard normal unknowns u; log(value of term j) = log(median) + sum spread * u.
struct MotionPrior {
  struct Hang {
    Eigen::Index unknown;
    double spread;
  };
  MotionModel medians;
  std::vector<std::vector<Hang>> hangs;  ///< one list a term
  Eigen::Index unknowns = 0;
};

/// Translation errors are a part of the way, so that the unit of length, unknown to a monocular
/// camera, does not matter; rotation errors are judged by the turning gaps, which odometry makes.
/// Terms of one cause and half get equal parts; terms that nothing could feed are dropped.
///
/// Closures keep their stated covariance unless they close gaps five times smaller than it: some
/// files state units of their own. Then it shrinks as far as what odometry states shrinks, but not
/// below a tenth of the gaps.
///
/// `gap` holds the closures' gaps when no edge is corrected, six numbers a closure.
/// O(edges terms + closures).
MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap);

/// O(terms).
MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns);

}  // namespace loopbench
