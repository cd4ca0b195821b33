/// Prior of the noise model, and its posterior given the loop gaps, by Markov chain Monte Carlo.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "methods/correctors/motion_drift/evidence.hpp"
#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench::methods {

/// Prior medians of terms that are not given as options, and their uncertainty. A dispersion is the
/// standard deviation of the log of a variance. Tuned on the development chains of results/methods,
/// in which drift exceeds noise after 4 s to 5 min.
struct MotionPriorOptions {
  double noise_ratio = 0.002;  ///< translation noise along a loop / path length of the loop [-]
  double stated_fraction =
      0.33;  ///< of the rotation noise variance, proportional to stated covariances [-]
  double drift_after = 60.0;  ///< loop duration at which drift and noise have equal variance [s]
  double common_dispersion = 2.3;      ///< scale common to all errors of a component
  double drift_dispersion = 1.8;       ///< ratio of drift to noise
  double axis_dispersion = 1.5;        ///< drift of one body axis relative to the others
  double term_dispersion = 0.7;        ///< a single term
  double stated_dispersion = 1.5;      ///< the stated odometry covariance relative to the scale
  double closures_dispersion = 0.7;    ///< factors on the closure covariances
  double as_stated_probability = 0.5;  ///< probabilities of Covariance; `free` has the remainder
  double scaled_probability = 0.25;
  double drift_probability = 0.7;  ///< probability of drift
  double drift_reach = 2.0;        ///< extrapolation of drift / motion enclosed by loops [-]
};

/// Hypotheses about the covariances. as_stated: all stated covariances times one common factor, on
/// which no trajectory depends (without drift: `dual`). scaled: one factor for the odometry and
/// separate ones for the closures. free: additional noise that grows with the motion.
enum class Covariance { as_stated, scaled, free };

/// Model selection between the general model and simpler special cases. If the loops carry little
/// information, the simple hypotheses keep their prior probabilities and the result stays near that
/// of `dual`; a more complex hypothesis has to explain the gaps correspondingly better.
///
/// The unknowns u are independent standard normal. u[0] selects the hypothesis: its normal
/// distribution function is compared with the cumulative probabilities of the hypotheses. Under
/// that hypothesis, log(value of term j) = log(median_j) + sum coefficient * u.
struct MotionPrior {
  struct Loading {
    Eigen::Index unknown;
    double coefficient;
  };
  struct Hypothesis {
    Covariance covariance = Covariance::free;
    bool has_drift = true;
    double probability = 1.0;
    MotionModel medians;  ///< the same terms in all hypotheses; excluded terms are 0
    std::vector<std::vector<Loading>> loadings;  ///< one list per term
  };
  /// The last hypothesis excludes no term.
  std::vector<Hypothesis> hypotheses;
  Eigen::Index unknowns = 1;
};

/// Derives the prior from the loops. Translation noise is a fraction of the path length, so the
/// unknown scale of a monocular camera does not matter; rotation noise is set by the rotation gaps.
/// Terms of the same kind and component share the variance equally; terms without any regressor are
/// dropped.
///
/// Closures keep their stated covariance unless their gaps are more than five times smaller than
/// the stated deviations (some files use other units). In that case the covariance shrinks by the
/// same factor as that of the odometry, but not below a tenth of the gaps in standard deviation.
/// Means over the loops are weighted (loop_averages.hpp): a closure with almost no information
/// changes nothing, and a loop at rest does not determine an error per metre.
///
/// `gap` holds the gaps of the uncorrected chain, six numbers per closure. O(edges terms +
/// closures).
MotionPrior prior_of(const MotionModel& model,
                     const MotionPriorOptions& options,
                     const Problem& problem,
                     const std::vector<EdgeMotion>& motions,
                     const Eigen::VectorXd& gap);

/// Index of the hypothesis selected by u[0]. O(hypotheses).
std::size_t hypothesis_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns);

/// Error model at the unknowns u. O(terms).
MotionModel model_at(const MotionPrior& prior, const Eigen::VectorXd& unknowns);

struct Sampling {
  int draws = 256;
  int steps = 8;      ///< steps between draws
  int burn_in = 120;  ///< steps before the first draw
  std::int64_t seed = 1;
};

struct MotionPosterior {
  std::vector<MotionModel> draws;
  std::vector<double> probabilities;  ///< posterior of the hypotheses: shares of the draws
  MotionModel centre;         ///< geometric mean of the draws of the most probable hypothesis
  double log_evidence = 0.0;  ///< log evidence of the gaps, mean over the draws
};

/// Draws from the product of the prior and exp(log_evidence()). Each step redraws the hypothesis
/// (Metropolis) and then takes one step of elliptical slice sampling, which has no parameters: from
/// u and a random normal v to the first tried point above the threshold on the ellipse through
/// both. Bit-identical for equal seeds. Throws std::runtime_error if the covariance of the gaps is
/// not positive definite at u = 0. O(steps (gaps^3 + gaps^2 terms)), with about six points per
/// step. Source: Murray, Adams, MacKay, Elliptical slice sampling, AISTATS 2010.
MotionPosterior posterior_of(const MotionPrior& prior,
                             const Evidence& evidence,
                             const Sampling& sampling);

}  // namespace loopbench::methods
