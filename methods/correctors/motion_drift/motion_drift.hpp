/// A chain corrected under a model of how its odometry errs: with motion, and steadily.
#pragma once

#include "methods/correctors/motion_drift/posterior.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// The error of odometry edge i is e_i = sum_j B_j phi_j(i) + w_i with phi the edge's duration
/// [s], length [m] and turn [rad]:
///
/// - noise w_i ~ N(0, S_i), S_i = a dt + b d + c |dtheta| + g (d / dt)^2 dt, for translation and
///   rotation apart, on all three axes alike, plus a multiple of the covariance the edge states;
/// - steady drift B_j ~ N(0, V_j) of rotation: unknown rates, the same all along the chain. They
///   make a chain's errors hang together, which noise alone denies, and loops far apart in time
///   teach them. Steady drift of translation (a wrong scale) hardly opens a loop, so that loops
///   cannot teach it; it is there when its size is given. Beyond the loops drift is extrapolated
///   over twice the motion that they enclose, and no further (drift_reach.hpp).
///
/// Nobody knows these variances, and a few loops do not tell them: they are drawn from what is
/// believed of them before (prior.hpp) times the density of the gaps that the loops leave
/// (posterior.hpp), and the answer is the mean of the errors that the models drawn expect
/// (mean_errors.hpp), relinearised until it rests. No reference is needed. Simple hypotheses are
/// believed beside the full model: that all covariances are as stated, or wrong by a factor each
/// for odometry and closures; that nothing drifts. Where loops say little the answer stays near
/// `dual`'s. Values given as options (by `loopbench calibrate`) replace the prior's medians; with
/// `fit: false` they are kept as they are.
///
/// With more than `average_closures` closures, which leave little doubt, one model stands for all:
/// the logarithmic mean of those drawn of the likeliest hypothesis. Where edges change the unit of
/// length (Sim(3)) that is settled first, as in `dual`.
///
/// Complexity O(edges + (6 closures)^3) some ten times, O((6 fit_closures)^3) some thousand times.
/// Sources: design notes, methods 5; Murray, Adams, MacKay, Elliptical slice sampling, AISTATS
/// 2010; Hoeting et al., Bayesian model averaging, Statistical Science 1999.
class MotionDrift final : public Corrector {
 public:
  /// What errors grow with, each including those before it. `drift` adds steady drift and what the
  /// edges state to `rotation`: speed is left out, for between even keyframes it is distance again.
  enum class Model { constant, time, distance, rotation, speed, drift };
  using Values = std::array<std::optional<double>, kGrowths.size()>;  ///< by Growth

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
    std::array<Values, 2> noise{};                    ///< by Half; variances
    std::array<Values, 2> drift{};                    ///< by Half; standard deviations of the rates
    std::array<std::optional<double>, 2> closures{};  ///< by Half; factors on the stated covariance
  };
  explicit MotionDrift(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations`, `log_evidence` of the gaps, `chance.*` of the hypotheses given the gaps,
  /// every variance of the likeliest one by its name (0: denied), `largest_move` of a keyframe and
  /// the `explained_move` [m] (large_moves.hpp). Notes when the first is far above the second.
  /// Throws std::runtime_error when the loop equations cannot be solved.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Trajectory correct_rigid(const Problem& problem, Report& report) const;
  /// Both return the iterations they took.
  int most_likely(LoopedChain& chain) const;
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
  visit("model", o.model, "what errors grow with, each with those before it");
  visit("fit", o.fit, "fit the variances to the loops; false: keep guesses and given values");

  MotionPriorOptions& p = o.prior;
  const Between share{0.0, 1.0};
  const Between spread{0.0, 10.0};
  visit("prior.noise_part", p.noise_part, "translation noise a loop, of its way", Above{0.0});
  visit("prior.stated_part", p.stated_part, "of the noise, shaped as edges state [-]", share);
  visit("prior.steady_after",
        p.steady_after,
        "length of loops that gather as much from drift as from noise [s]",
        Above{0.0});
  visit("prior.scale_spread", p.scale_spread, "of a half's errors, in logarithms [-]", spread);
  visit("prior.steady_spread", p.steady_spread, "of drift against noise [-]", spread);
  visit("prior.axis_spread", p.axis_spread, "of an axis' drift against the others' [-]", spread);
  visit("prior.share_spread", p.share_spread, "of each term beside all that [-]", spread);
  visit("prior.stated_spread", p.stated_spread, "of what edges state beside that [-]", spread);
  visit("prior.closures_spread", p.closures_spread, "of the closures' factors [-]", spread);
  visit("prior.as_stated_chance",
        p.as_stated_chance,
        "that all err as stated, but for one factor [-]",
        share);
  visit("prior.scaled_chance", p.scaled_chance, "that closures need another factor [-]", share);
  visit("prior.steady_chance", p.steady_chance, "that anything drifts steadily [-]", share);
  visit("prior.drift_reach",
        p.drift_reach,
        "extrapolation of drift beyond the loops, as a multiple of the motion they enclose [-]",
        Between{0.0});

  visit("draws",
        o.sampling.draws,
        "error models averaged; with more than 16 closures 64 of them",
        Between{1, 10000});
  visit("draw_steps", o.sampling.steps, "of the sampler from draw to draw", Between{1, 1000});
  visit("warm_up", o.sampling.warm_up, "steps before the first draw", Between{0, 100000});
  visit("seed", o.sampling.seed, "of the sampler", Between{0});
  visit("fit_closures", o.fit_closures, "closures the fit looks at, well spread", Between{1, 300});
  visit("average_closures",
        o.average_closures,
        "with more, one model stands for all drawn",
        Between{0, 2000});
  visit("max_iterations", o.max_iterations, "relinearisations after that", Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "relative change of cost or squared errors that ends them [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "declines above: the dense solve grows with their cube",
        Between{1, 2000});
  visit("scale", o.scale, "first settle the unit of length where edges change it (Sim(3) chains)");

  const char* none = "none: guessed";
  const auto by_growth = [&](const std::string& what, MotionDrift::Values& values, auto first) {
    for (std::size_t g = first; g < kGrowths.size(); ++g) {
      visit((what + ".per_" + name_of(kGrowths[g])).c_str(), values[g], none, Between{0.0});
    }
  };
  by_growth("noise.t", o.noise[0], 0u);  // [m^2/unit]
  by_growth("noise.r", o.noise[1], 0u);  // [rad^2/unit]
  by_growth("drift.t", o.drift[0], 1u);  // [m/unit]
  by_growth("drift.r", o.drift[1], 1u);  // [rad/unit]
  visit("closures.t", o.closures[0], none, Above{0.0});
  visit("closures.r", o.closures[1], none, Above{0.0});
}

}  // namespace loopbench
