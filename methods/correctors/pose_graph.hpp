/// Pose-graph optimisation, standard and robust.
#pragma once

#include "methods/correctors/consensus/calibrated.hpp"
#include "methods/correctors/gnc.hpp"
#include "methods/method.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench::methods {

/// Maximum likelihood estimate of all keyframes of any connected graph, with odometry and closures
/// weighted by their information (solve_pose_graph()). Poses are in SE(2) when the problem is
/// planar (the same minimum at lower cost), in Sim(3) when an edge changes the scale, otherwise in
/// SE(3); `group` overrides this. The resulting poses are rigid, in the scale of the first
/// keyframe.
///
/// False closures are handled in one of three ways. (1) The bounded `loss` dcs. It also rejects
/// true closures where the odometry has drifted by more than a closure's deviations. The problem is
/// therefore also solved with a width that shrinks from the largest error, and the solution of
/// lower cost is kept. (2) Graduated non-convexity (`gnc`), which rejects closures whose squared
/// error stays above the group's 99 % quantile. (3) Pairwise consistency (Checked). Odometry is
/// assumed to have no outliers.
///
/// With complete odometry, GNC starts from the largest consistent set of closures (solve_gnc()): a
/// closure's own information does not describe the odometry drift between its keyframes, so
/// starting from all closures rejects true closures where drift is large. Closures that are stated
/// as almost exact are solved with bounded information (stiffness.hpp).
///
/// Anchors have no loss. The start is aligned to them if they determine the frame (anchors.hpp).
///
/// With `gravity`, roll and pitch of each keyframe are those of the input (LevelledProblem).
///
/// Complexity: a few sparse factorisations, near linear in keyframes for chains; 10 to 30 times
/// that for GNC. Sources: Grisetti et al., A tutorial on graph-based SLAM, 2010; Agarwal et al.,
/// Dynamic covariance scaling, ICRA 2013; Suenderhauf and Protzel, Switchable constraints, IROS
/// 2012; Yang et al., Graduated non-convexity, RA-L 2020.
class PoseGraphOptimizer final : public Corrector {
 public:
  enum class Poses { automatic, se2, se3, sim3 };
  enum class Start { keyframes, odometry, chordal };

  struct Options {
    Poses group = Poses::automatic;
    Start start = Start::keyframes;
    RobustLoss loss = RobustLoss::none;
    std::optional<double> loss_width = std::nullopt;
    Gnc gnc = Gnc::off;
    double scale_sigma = 0.01;
    int max_iterations = 1000;
    double tolerance = 1e-14;
    bool gravity = false;
    bool calibrate = false;
    bool rescale = false;  ///< old name of `calibrate`
    bool covariances = false;
  };
  explicit PoseGraphOptimizer(const Options& options) : options_(options) {}

  /// Declines problems without closures, with unconnected keyframes, non-planar ones with SE(2),
  /// and edges that change the scale with `gravity`.
  std::string why_declined(const Problem& problem) const override;

  /// `gnc` and `calibrate` know no anchors.
  bool accepts_anchors() const override {
    return options_.gnc == Gnc::off && !is_calibrated(options_);
  }

  /// Counts: `iterations` (linear solves), `chi2_before`, `chi2` (sum of squared Mahalanobis
  /// errors; with a loss `robust_chi2`, sum of losses), without a loss `chi2_per_dof`, with
  /// `gravity` the `tilt_error` [deg], with `calibrate` the factors `factor_t`, `factor_r`,
  /// `factor_closures` on deviations, and with GNC `gnc_rounds` and `closures_kept`. With GNC and
  /// dcs the report states the rejected closures, those with at most half of their weight. States
  /// covariances if asked (graph_covariance.hpp). Throws std::runtime_error when the solver finds
  /// no usable solution.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(PoseGraphOptimizer::Poses) {
  return std::array{std::pair{"auto", PoseGraphOptimizer::Poses::automatic},
                    std::pair{"se2", PoseGraphOptimizer::Poses::se2},
                    std::pair{"se3", PoseGraphOptimizer::Poses::se3},
                    std::pair{"sim3", PoseGraphOptimizer::Poses::sim3}};
}
inline auto choices(PoseGraphOptimizer::Start) {
  return std::array{std::pair{"keyframes", PoseGraphOptimizer::Start::keyframes},
                    std::pair{"odometry", PoseGraphOptimizer::Start::odometry},
                    std::pair{"chordal", PoseGraphOptimizer::Start::chordal}};
}

template <class Visit>
void fields(PoseGraphOptimizer::Options& o, Visit visit) {
  visit("group",
        o.group,
        "Lie group of the poses; auto: se2 if planar, sim3 if edges change the scale, else se3");
  visit("start",
        o.start,
        "initial values: keyframes, odometry integrated from the first keyframe, or chordal "
        "relaxation, continued by the equations of dual on chains of at most 20 loops");
  visit("loss", o.loss, "robust loss on the closures; dcs is bounded");
  visit("loss_width",
        o.loss_width,
        "width of the loss as a squared error [-]; none: the group's 99 % quantile for dcs, 1 for "
        "others",
        GreaterThan{0.0});
  visit("gnc", o.gnc, "graduated non-convexity: off, tls (truncated least squares)");
  visit("scale_sigma",
        o.scale_sigma,
        "standard deviation in sim3 of the log scale of edges whose graph states none [-]",
        GreaterThan{0.0});
  visit("max_iterations",
        o.max_iterations,
        "maximum number of iterations per solve",
        Between{1, 10000});
  visit("tolerance",
        o.tolerance,
        "convergence threshold: relative change of the cost [-]",
        GreaterThan{0.0});
  visit(
      "gravity",
      o.gravity,
      "hold roll and pitch of each keyframe as given, because gravity was measured; the z axis of "
      "the world must be vertical");
  calibration_fields(o, visit);
  visit("covariances", o.covariances, "state the covariance of each keyframe, for metric nees");
}

}  // namespace loopbench::methods
