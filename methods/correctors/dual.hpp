/// Maximum likelihood on a chain with few loops, solved in closed form for the loop multipliers.
#pragma once

#include "methods/correctors/consensus/calibrated.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// Computes the corrections e_i of the odometry edges Z_i (X_i = X_{i-1} Z_i Exp(e_i)) that
/// minimise
///
///     sum_i e_i' S_i^-1 e_i  +  sum_k eta_k' S_Lk^-1 eta_k,   eta_k = Log(L_k^-1 X_a^-1 X_b),
///
/// the cost of a pose graph whose odometry is a chain. Linearised at the current poses,
/// eta = c + A e with A_ki = J^-1(eta_k) Ad(X_b^-1 X_i) J(e_i) for a < i <= b, and
///
///     (A S A' + S_L) lambda = c,   e_i = -S_i sum_k A_ki' lambda_k,
///
/// The system is relinearised until convergence, about ten times; near the minimum the step
/// includes the curvature of the loops (newton_direction()). Every block of A S A' is a difference
/// of one prefix sum over the chain, so an iteration costs O(n + (6 K)^3) time and O(n + (6 K)^2)
/// memory for n keyframes and K closures, without a sparse solver. For many loops a pose graph is
/// the better choice.
///
/// The initial values are the keyframes. If chi2 at that minimum is larger than its distribution
/// allows, chordal relaxation (initial_values.hpp) provides a second start, and the lower minimum
/// is returned. `calibrate` first replaces the stated deviations by those that the closures show
/// (calibrated.hpp).
///
/// Anchors are loops from a fixed world in which only a position is measured: three rows of the
/// same equations. With them the equations start from the solution of `pose_graph`, so that both
/// end in one minimum; with start `keyframes` from the keyframes, aligned to the anchors.
///
/// Odometry edges must join all neighbouring keyframes. Full information matrices are used.
/// Source: generalised least squares with few constraints.
class Dual final : public Corrector {
 public:
  enum class Start { automatic, keyframes };
  enum class Use { all, closures, anchors };
  struct Options {
    int max_iterations = 500;
    double tolerance = 1e-10;
    int max_closures = 300;
    Start start = Start::automatic;
    bool calibrate = false;
    bool rescale = false;  ///< old name of `calibrate`
    Use use = Use::all;
    bool covariances = false;
  };
  explicit Dual(const Options& options) : options_(options) {}

  /// Declines, among others, edges that change the scale.
  std::string why_declined(const Problem& problem) const override;

  /// `calibrate` knows no anchors.
  bool accepts_anchors() const override {
    return !is_calibrated(options_) || options_.use == Use::closures;
  }

  /// Counts: `iterations`, `chi2_before`, `chi2` (the sum above), `chi2_per_dof`,
  /// and with `calibrate` the factors `factor_t`, `factor_r`, `factor_closures`. Note:
  /// two minima. Throws std::runtime_error when the cost is not finite.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(Dual::Start) {
  return std::array{std::pair{"auto", Dual::Start::automatic},
                    std::pair{"keyframes", Dual::Start::keyframes}};
}

inline auto choices(Dual::Use) {
  return std::array{std::pair{"all", Dual::Use::all},
                    std::pair{"closures", Dual::Use::closures},
                    std::pair{"anchors", Dual::Use::anchors}};
}

template <class Visit>
void fields(Dual::Options& o, Visit visit) {
  visit("max_iterations", o.max_iterations, "maximum number of relinearisations", Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "convergence threshold: relative change of the cost [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "maximum number of closures and anchors; the time of the dense solve grows with its cube",
        Between{1, 2000});
  visit("start",
        o.start,
        "initial values; auto: keyframes, then chordal relaxation if chi2 is implausibly large, or "
        "with anchors the solution of pose_graph");
  calibration_fields(o, visit);
  visit("use", o.use, "measurements that are used, to compare what closures and anchors add");
  visit("covariances", o.covariances, "state the covariance of each keyframe, for metric nees");
}

}  // namespace loopbench::methods
