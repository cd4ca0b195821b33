/// What to believe of an error model before the loops are looked at closely.
#pragma once

#include <Eigen/Core>

#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench {

/// How large errors are thought to be, for terms that are not given, and how far each may be from
/// that. Spreads are standard deviations of logarithms of variances. Learnt on the development
/// chains of results/methods: there steady drift outweighs noise after 4 s to 5 min.
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
  double as_stated_chance = 0.5;  ///< see Covariance; the rest is its last
  double scaled_chance = 0.25;
  double steady_chance = 0.7;  ///< that anything drifts steadily
  double drift_reach = 2.0;    ///< of drift beyond the loops, of the motion they enclose [-]
};

/// What the noise may be like. As stated: every covariance of the problem times one factor, which
/// no trajectory depends on (without drift: `dual`). Scaled: odometry times one factor, closures
/// times others. Free: growing with the motion, besides.
enum class Covariance { as_stated, scaled, free };

/// Simple hypotheses beside the one that all are cases of: loops that say little leave them their
/// chances, and so the answer near `dual`'s; what is more has to explain the gaps that much better.
///
/// Independent standard normal unknowns u. u[0] chooses the hypothesis: the one whose part of all
/// chances the distribution function of u[0] falls into. There log(value of term j) = log(median) +
/// sum spread * u.
struct MotionPrior {
  struct Hang {
    Eigen::Index unknown;
    double spread;
  };
  struct Hypothesis {
    Covariance covariance = Covariance::free;
    bool steady = true;  ///< drift
    double chance = 1.0;
    MotionModel medians;                   ///< the same terms in all; those it denies are zero
    std::vector<std::vector<Hang>> hangs;  ///< one list a term
  };
  /// The last denies nothing.
  std::vector<Hypothesis> hypotheses;
  Eigen::Index unknowns = 1;
};

/// Translation errors are a part of the way, so that the unit of length, unknown to a monocular
/// camera, does not matter; rotation errors are judged by the turning gaps, which odometry makes.
/// Terms of one cause and half get equal parts; terms that nothing could feed are dropped.
///
/// Closures keep their stated covariance unless they close gaps five times smaller than it: some
/// files state units of their own. Then it shrinks as far as what odometry states shrinks, but not
/// below a tenth of the gaps. Means over the loops are weighted (loop_averages.hpp): a closure that
/// states nearly nothing changes nothing, and a loop at rest does not set an error per metre.
///
/// `gap` holds the closures' gaps when no edge is corrected, six numbers a closure.
/// O(edges terms + closures).
MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap);

/// The hypothesis that u chooses. O(hypotheses).
std::size_t hypothesis_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns);

/// O(terms).
MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns);

}  // namespace loopbench
