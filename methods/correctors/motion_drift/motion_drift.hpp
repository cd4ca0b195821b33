/// Corrects a chain under an odometry noise model with motion-dependent noise and drift.
#pragma once

#include "methods/correctors/motion_drift/posterior.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// The error of odometry edge i is e_i = sum_j B_j phi_j(i) + w_i. The regressors phi_j are the
/// edge's duration [s], length [m] and rotation angle [rad].
///
/// - Noise: w_i ~ N(0, S_i), S_i = a dt + b d + c |dtheta|, separately for translation and
///   rotation and equal on all three axes, plus a multiple of the edge's stated covariance.
/// - Drift: B_j ~ N(0, V_j), unknown rotation rates that are constant along the chain. They
///   correlate the errors of the whole chain, and loops far apart in time determine them. Drift
///   of translation (a wrong scale) hardly opens a loop, so loops cannot determine it; it is
///   used only when its size is given as an option. Outside the loops, drift is extrapolated over
///   at most `prior.drift_reach` times the motion that the loops enclose (limit_drift()).
///
/// A few loops do not determine these variances. The method therefore draws noise models from the
/// posterior: a prior times the likelihood of the loop gaps (posterior.hpp). It corrects the chain
/// by the expected errors averaged over the drawn models (mean_errors()) and relinearises until
/// convergence. No reference is needed. The prior also contains simpler hypotheses: all covariances
/// as stated, one factor for the odometry and one each for the closures, no drift. Values given as
/// options replace the prior medians; with `fit: false` they are used unchanged.
///
/// With fewer than `abstain.closures` closures the loops cannot tell whether stated covariances are
/// wrong or drift is steady, and averages over both were up to 94 % worse than `dual`. The result
/// is then exactly that of `dual`, unless the Bayes factor of drift is at least
/// `abstain.bayes_factor`.
///
/// With more than `average_closures` closures the posterior is narrow, and one model is used: the
/// geometric mean of the models drawn under the most probable hypothesis. Scale changes of edges
/// (Sim(3)) are estimated and removed first, as in `dual`.
///
/// Where other chains of the odometer are known (Problem::related), drift that repeats in them is
/// removed first (shared_drift.hpp); where the method abstains then, the result is that of `dual`
/// with `rescale`.
///
/// Complexity: about ten times O(edges + (6 closures)^3) and about a thousand times O((6
/// fit_closures)^3). Sources: Murray, Adams, MacKay, Elliptical slice
/// sampling, AISTATS 2010; Hoeting et al., Bayesian model averaging, Statistical Science 1999.
class MotionDrift final : public Corrector {
 public:
  using Values = std::array<std::optional<double>, kRegressors.size()>;  ///< indexed by Regressor

  struct Options {
    bool fit = true;
    MotionPriorOptions prior = {};
    Sampling sampling = {};
    int fit_closures = 8;
    int average_closures = 60;
    int abstain_closures = 8;
    double abstain_factor = 9.0;
    int max_iterations = 20;
    double tolerance = 1e-14;
    int max_closures = 300;
    bool scale = true;
    bool related = true;
    std::array<Values, 2> noise{};  ///< by Component; variances
    std::array<Values, 2> drift{};  ///< by Component; standard deviations of the rates
    std::array<std::optional<double>, 2>
        closures{};  ///< by Component; factors on stated covariances
  };
  explicit MotionDrift(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override;

  /// Counts: `iterations`; `log_evidence` of the gaps; `probability.*`, the posterior probabilities
  /// of the hypotheses; the values of the most probable hypothesis, named and scaled like the
  /// options (noise: variances; drift: standard deviations of the rates; 0: term excluded);
  /// `shared.per_metre.x` and so on: rates that were removed; `abstained` (1) and the counts of
  /// `dual` in place of these values; `largest_move` of a keyframe and `explained_move` [m], what
  /// the gap of one closure explains. Adds a note when largest_move is far above explained_move.
  /// Throws std::runtime_error when the loop equations cannot be solved.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  /// `rescale`: option of `dual` where the method abstains.
  Trajectory correct_rigid(const Problem& problem, Report& report, bool rescale) const;
  bool abstains(const MotionPrior& prior,
                const MotionPosterior& posterior,
                std::size_t closures) const;
  /// Returns the number of iterations.
  int average(const std::vector<MotionModel>& models,
              LoopedChain& chain,
              const Problem& problem,
              const std::vector<EdgeMotion>& moved) const;

  Options options_;
};

template <class Visit>
void fields(MotionDrift::Options& o, Visit visit) {
  visit(
      "fit",
      o.fit,
      "estimate the variances from the loops, with given values as prior medians; false: use given "
      "values unchanged and prior medians for the others");

  MotionPriorOptions& p = o.prior;
  const Between share{0.0, 1.0};
  visit("prior.as_stated_probability",
        p.as_stated_probability,
        "prior probability that all stated covariances are correct up to one common factor and no "
        "other noise exists; ignored if a noise variance above 0 is given [-]",
        share);
  visit("prior.scaled_probability",
        p.scaled_probability,
        "prior probability that odometry and closure covariances are correct up to separate "
        "factors; ignored if a noise variance above 0 is given; the remainder of both is the "
        "probability of noise that grows with the motion [-]",
        share);
  visit("prior.drift_probability", p.drift_probability, "prior probability of drift [-]", share);
  visit("prior.drift_reach",
        p.drift_reach,
        "drift is extrapolated outside the loops over at most this multiple of the time, distance "
        "and rotation angle inside them [-]",
        Between{0.0});

  visit(
      "abstain.closures",
      o.abstain_closures,
      "with fewer closures, the result is that of `dual` unless drift is nearly certain; 0: never; "
      "ignored with `fit: false` or if a variance, a drift or a factor above 0 is given",
      Between{0, 2000});
  visit("abstain.bayes_factor",
        o.abstain_factor,
        "Bayes factor, drift against no drift, from which drift is nearly certain [-]",
        Between{0.0});

  visit("draws",
        o.sampling.draws,
        "number of noise models drawn from the posterior; at most 64 of them are averaged when "
        "there are more than 16 closures",
        Between{1, 10000});
  visit("seed", o.sampling.seed, "seed of the sampler's random numbers", Between{0});
  visit("max_iterations",
        o.max_iterations,
        "maximum number of relinearisations in each stage: before and after the estimation of the "
        "variances, and while averaging",
        Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "convergence threshold: relative change of the cost or of the squared corrections [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "maximum number of closures, above which the method declines; the time of the dense solve "
        "grows with its cube",
        Between{1, 2000});
  visit("scale", o.scale, "estimate and remove scale drift first (Sim(3) chains)");
  visit(
      "related",
      o.related,
      "first remove rotation drift that repeats in the loops of the other chains of the sweep that "
      "have the same `odometer`");

  const auto by_regressor = [&](const std::string& what,
                                const std::string& help,
                                const std::string& none,
                                MotionDrift::Values& values,
                                auto first) {
    constexpr std::array kPer{" per odometry edge",
                              " per second",
                              " per metre",
                              " per radian of rotation angle",
                              " per squared speed times duration"};
    for (std::size_t g = first; g < kRegressors.size(); ++g) {
      visit((what + ".per_" + name_of(kRegressors[g])).c_str(),
            values[g],
            (help + kPer[g] + "; none: " + none).c_str(),
            Between{0.0});
    }
  };
  const std::string median = "median derived from the loops; per edge and per speed: no such term";
  by_regressor("noise.t", "translation noise variance on each axis [m^2]", median, o.noise[0], 0u);
  by_regressor("noise.r", "rotation noise variance on each axis [rad^2]", median, o.noise[1], 0u);
  by_regressor("drift.t",
               "standard deviation of the constant rate of translation drift [m]",
               "no such drift, because loops do not determine it",
               o.drift[0],
               1u);
  by_regressor("drift.r",
               "standard deviation of the constant rate of rotation drift [rad]",
               median,
               o.drift[1],
               1u);
  visit("closures.t",
        o.closures[0],
        "factor on the stated translation covariance of the closures [-]; none: derived "
        "from the loops",
        GreaterThan{0.0});
  visit("closures.r",
        o.closures[1],
        "factor on the stated rotation covariance of the closures [-]; none: derived "
        "from the loops",
        GreaterThan{0.0});
}

}  // namespace loopbench::methods
