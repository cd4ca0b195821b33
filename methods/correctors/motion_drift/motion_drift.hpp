/// Corrects a chain under an odometry error model with motion-dependent noise and steady drift.
#pragma once

#include "methods/correctors/motion_drift/posterior.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// The error of odometry edge i is e_i = sum_j B_j phi_j(i) + w_i. The regressors phi_j are the
/// edge's duration [s], length [m] and rotation angle [rad].
///
/// - Noise: w_i ~ N(0, S_i), S_i = a dt + b d + c |dtheta| + g (d / dt)^2 dt, separately for
///   translation and rotation and equal on all three axes, plus a multiple of the edge's stated
///   covariance.
/// - Steady drift: B_j ~ N(0, V_j), unknown rotation rates that are constant along the chain. They
///   correlate the errors of the whole chain, and loops far apart in time determine them. Steady
///   drift of translation (a wrong scale) hardly opens a loop, so loops cannot determine it; it is
///   used only when its size is given as an option. Outside the loops, drift is extrapolated over
///   at most `prior.drift_reach` times the motion that the loops enclose (drift_reach.hpp).
///
/// A few loops do not determine these variances. The method therefore draws error models from the
/// posterior: a prior (prior.hpp) times the likelihood of the loop gaps (posterior.hpp). It
/// corrects the chain by the expected errors averaged over the drawn models (mean_errors.hpp) and
/// relinearises until convergence. No reference is needed. The prior also contains simpler
/// hypotheses: all covariances as stated, one factor for the odometry and one each for the
/// closures, no drift. Where the loops carry little information the result stays near that of
/// `dual`. Values given as options (for example by `loopbench calibrate`) replace the prior
/// medians; with `fit: false` they are used unchanged.
///
/// With more than `average_closures` closures the posterior is narrow, and one model is used: the
/// geometric mean of the models drawn under the most probable hypothesis. Scale changes of edges
/// (Sim(3)) are estimated and removed first, as in `dual`.
///
/// Complexity: about ten times O(edges + (6 closures)^3) and about a thousand times O((6
/// fit_closures)^3). Sources: design notes, methods 5; Murray, Adams, MacKay, Elliptical slice
/// sampling, AISTATS 2010; Hoeting et al., Bayesian model averaging, Statistical Science 1999.
class MotionDrift final : public Corrector {
 public:
  /// Noise terms of the error model. `constant` noise is equal in every edge; `time`, `distance`,
  /// `rotation` and `speed` each add a regressor to the one before. `drift` is `rotation` plus
  /// steady drift and the stated odometry covariance; it omits speed, because for evenly spaced
  /// keyframes speed is proportional to distance.
  enum class Model { constant, time, distance, rotation, speed, drift };
  using Values = std::array<std::optional<double>, kRegressors.size()>;  ///< indexed by Regressor

  struct Options {
    Model model = Model::drift;
    bool fit = true;
    MotionPriorOptions prior = {};
    Sampling sampling = {};
    int fit_closures = 8;
    int average_closures = 60;
    int max_iterations = 20;
    double tolerance = 1e-14;
    int max_closures = 300;
    bool scale = true;
    std::array<Values, 2> noise{};  ///< by Component; variances
    std::array<Values, 2> drift{};  ///< by Component; standard deviations of the rates
    std::array<std::optional<double>, 2>
        closures{};  ///< by Component; factors on stated covariances
  };
  explicit MotionDrift(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations`; `log_evidence` of the gaps; `chance.*`, the posterior probabilities of
  /// the hypotheses; the variances of the most probable hypothesis by name (0: term excluded);
  /// `largest_move` of a keyframe and `explained_move` [m] (large_moves.hpp). Adds a note when
  /// largest_move is far above explained_move. Throws std::runtime_error when the loop equations
  /// cannot be solved.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Trajectory correct_rigid(const Problem& problem, Report& report) const;
  /// Returns the number of iterations.
  int average(const std::vector<MotionModel>& models,
              LoopedChain& chain,
              const Problem& problem,
              const std::vector<EdgeMotion>& moved) const;

  Options options_;
};

inline auto choices(MotionDrift::Model) {
  using Model = MotionDrift::Model;
  return std::array{std::pair{"const", Model::constant},
                    std::pair{"time", Model::time},
                    std::pair{"distance", Model::distance},
                    std::pair{"rotation", Model::rotation},
                    std::pair{"speed", Model::speed},
                    std::pair{"drift", Model::drift}};
}

template <class Visit>
void fields(MotionDrift::Options& o, Visit visit) {
  visit(
      "model",
      o.model,
      "error terms of the model; const: equal in every edge; time, distance, rotation, speed: "
      "noise that grows with that quantity and those before it; drift: rotation plus steady drift");
  visit("fit",
        o.fit,
        "estimate the variances from the loops; false: use prior medians and given values");

  MotionPriorOptions& p = o.prior;
  const Between share{0.0, 1.0};
  const Between deviation{0.0, 10.0};
  visit("prior.noise_part",
        p.noise_part,
        "prior translation noise along a loop, as a fraction of its path length [-]",
        GreaterThan{0.0});
  visit("prior.stated_part",
        p.stated_part,
        "prior fraction of the rotation noise that is proportional to the stated covariances of "
        "the odometry [-]",
        share);
  visit("prior.steady_after",
        p.steady_after,
        "loop duration at which drift and noise contribute equal rotation variance a priori [s]",
        GreaterThan{0.0});
  visit("prior.scale_dispersion",
        p.scale_dispersion,
        "standard deviation of the log variance scale common to all translation (or rotation) "
        "errors [-]",
        deviation);
  visit("prior.steady_dispersion",
        p.steady_dispersion,
        "standard deviation of the log ratio of drift to noise variance [-]",
        deviation);
  visit("prior.axis_dispersion",
        p.axis_dispersion,
        "standard deviation of the log drift variance of one body axis [-]",
        deviation);
  visit("prior.share_dispersion",
        p.share_dispersion,
        "standard deviation of the log variance of one term (time, distance, rotation) [-]",
        deviation);
  visit("prior.stated_dispersion",
        p.stated_dispersion,
        "standard deviation of the log factor on the stated odometry covariances [-]",
        deviation);
  visit("prior.closures_dispersion",
        p.closures_dispersion,
        "standard deviation of the log factors on the stated closure covariances [-]",
        deviation);
  visit("prior.as_stated_chance",
        p.as_stated_chance,
        "prior probability that all stated covariances are correct up to one common factor [-]",
        share);
  visit("prior.scaled_chance",
        p.scaled_chance,
        "prior probability that odometry and closure covariances are correct up to separate "
        "factors [-]",
        share);
  visit("prior.steady_chance", p.steady_chance, "prior probability of steady drift [-]", share);
  visit("prior.drift_reach",
        p.drift_reach,
        "limit on extrapolating drift outside the loops, as a multiple of the motion enclosed by "
        "loops [-]",
        Between{0.0});

  visit("draws",
        o.sampling.draws,
        "number of error models drawn from the posterior; at most 64 of them are averaged when "
        "there are more than 16 closures",
        Between{1, 10000});
  visit("draw_steps", o.sampling.steps, "sampler steps between two draws", Between{1, 1000});
  visit("warm_up", o.sampling.warm_up, "sampler steps before the first draw", Between{0, 100000});
  visit("seed", o.sampling.seed, "seed of the sampler's random numbers", Between{0});
  visit("fit_closures",
        o.fit_closures,
        "maximum number of closures used to estimate the variances, evenly subsampled",
        Between{1, 300});
  visit("average_closures",
        o.average_closures,
        "maximum number of closures for averaging over models; above it one model is used",
        Between{0, 2000});
  visit("max_iterations",
        o.max_iterations,
        "maximum number of relinearisations after the variances are estimated",
        Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "convergence threshold: relative change of the cost or of the squared corrections [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "maximum number of closures; the time of the dense solve grows with its cube",
        Between{1, 2000});
  visit("scale", o.scale, "estimate and remove scale drift first (Sim(3) chains)");

  const auto by_regressor = [&](const std::string& what,
                                const std::string& help,
                                MotionDrift::Values& values,
                                auto first) {
    for (std::size_t g = first; g < kRegressors.size(); ++g) {
      const std::string unit = name_of(kRegressors[g]);
      visit((what + ".per_" + unit).c_str(),
            values[g],
            (help + (unit == "speed" ? "speed^2 times duration" : unit) + "; none: estimated")
                .c_str(),
            Between{0.0});
    }
  };
  by_regressor("noise.t", "translation noise variance on each axis [m^2] per ", o.noise[0], 0u);
  by_regressor("noise.r", "rotation noise variance on each axis [rad^2] per ", o.noise[1], 0u);
  by_regressor(
      "drift.t", "standard deviation of steady translation drift [m] per ", o.drift[0], 1u);
  by_regressor("drift.r", "standard deviation of steady rotation drift [rad] per ", o.drift[1], 1u);
  visit("closures.t",
        o.closures[0],
        "factor on the stated translation covariance of the closures [-]; none: estimated",
        GreaterThan{0.0});
  visit("closures.r",
        o.closures[1],
        "factor on the stated rotation covariance of the closures [-]; none: estimated",
        GreaterThan{0.0});
}

}  // namespace loopbench::methods
