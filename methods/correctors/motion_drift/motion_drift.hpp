/// Maximum likelihood on a chain under a model of how odometry errs: with motion, and steadily.
#pragma once

#include "methods/correctors/motion_drift/guess.hpp"
#include "methods/method.hpp"

namespace loopbench {

/// The error of odometry edge i is e_i = sum_j B_j phi_j(i) + w_i with phi the edge's duration
/// [s], length [m] and turn [rad]:
///
/// - noise w_i ~ N(0, S_i), S_i = a dt + b d + c |dtheta| + g (d / dt)^2 dt, for translation and
///   rotation apart, on all three axes alike;
/// - steady drift B_j ~ N(0, V_j): unknown rates, the same all along the chain. They make a chain's
///   errors hang together, which noise alone denies, and loops far apart in time teach them.
///
/// Loops are solved as Dual does, with the drift's share in their equations (looped_chain.hpp).
///
/// The variances need no reference. Each has a guess (guess.hpp), believed within exp(+-spread) of
/// its value: loosely for the common scale of translation and of rotation errors, closely for how
/// the parts compare, since few loops cannot tell those apart. The density of the gaps the loops
/// leave, times these beliefs, is maximised (variances.hpp), relinearising in between. The stated
/// information of odometry edges is not used but for judging the closures' units; that of closures
/// is, times a fitted factor on either half. Values given as options (by `loopbench calibrate`)
/// replace the guesses, and with `fit: false` they are kept as they are.
///
/// Complexity O(edges + (6 closures)^3 + (6 fit_closures)^3), times some ten and some hundred
/// rounds. Cause: design notes, methods 5; variance components: Zhou et al., 2019.
class MotionDrift final : public Corrector {
 public:
  /// What errors grow with, each including those before it. `drift` adds steady drift to
  /// `rotation`: speed is left out, for between even keyframes it is distance again.
  enum class Model { constant, time, distance, rotation, speed, drift };
  using Values = std::array<std::optional<double>, kGrowths.size()>;  ///< by Growth

  struct Options {
    Model model = Model::drift;
    bool fit = true;
    double scale_spread = 2.3;
    double share_spread = 0.5;
    double closures_spread = 2.0;
    Guess guess{.noise_part = 0.002, .drift_part = 0.003, .rotation_noise = 0.2};
    int fit_closures = 40;
    int fit_rounds = 4;
    int max_iterations = 20;
    double tolerance = 1e-14;
    int max_closures = 300;
    std::array<Values, 2> noise{};                    ///< by Half; variances
    std::array<Values, 2> drift{};                    ///< by Half; standard deviations of the rates
    std::array<std::optional<double>, 2> closures{};  ///< by Half; factors on the stated covariance
  };
  explicit MotionDrift(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations`, `cost` (under the fitted model), `log_evidence` of the gaps, and every
  /// variance by its name. Throws std::runtime_error when the loop equations cannot be solved.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  /// Leaves the model fitted and the chain near its solution; returns the log evidence.
  double fit_to_loops(MotionModel& model,
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
  const Between spread{0.0, 10.0};
  visit("scale_spread", o.scale_spread, "of the common scale's logarithm; 0: fixed [-]", spread);
  visit("share_spread", o.share_spread, "of each part's logarithm beside it [-]", spread);
  visit("closures_spread", o.closures_spread, "of the closures' factors' logarithms [-]", spread);
  visit("guess.noise_part", o.guess.noise_part, "translation noise a loop, of its way", Above{0.0});
  visit("guess.drift_part", o.guess.drift_part, "steady drift, of the way", Above{0.0});
  visit("guess.rotation_noise",
        o.guess.rotation_noise,
        "noise's part in squared turning gaps, the rest is drift's",
        Between{0.0, 1.0});
  visit("fit_closures", o.fit_closures, "closures the fit looks at, well spread", Between{1, 300});
  visit("fit_rounds", o.fit_rounds, "of fitting and relinearising", Between{1, 100});
  visit("max_iterations", o.max_iterations, "relinearisations after that", Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "relative change of the cost that ends them [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "declines above: the dense solve grows with their cube",
        Between{1, 2000});

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
