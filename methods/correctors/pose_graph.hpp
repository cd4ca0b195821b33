/// Pose-graph optimisation, plain and robust: the field's standard answer.
#pragma once

#include "methods/correctors/gnc.hpp"
#include "methods/method.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench {

/// Maximum likelihood over all keyframes of any connected graph: odometry and closures weighted by
/// their information, as solve_pose_graph() says. Poses move in SE(2) when the problem is planar
/// (the same minimum at a fraction of the cost), in Sim(3) when an edge changes the unit of length,
/// else in SE(3); `group` overrules that. The result's poses are rigid, in the unit of the first.
///
/// Closures may be false: then either a bounded `loss`, which at once rejects true closures where
/// odometry has drifted by more than a closure's deviations, so that it is also solved with a width
/// that shrinks from the largest error (`anneal`) and the lower cost is kept; or graduated
/// non-convexity
/// (`gnc`), which lets go of closures that stay above `inlier_chi2`; or only closures that agree
/// (Checked). Odometry is trusted. GNC starts from all closures, or where odometry is a whole chain
/// from the largest set that agrees (`gnc_start: consistent`, see gnc_pose_graph.hpp), `start`
/// being computed from these closures only: a closure's own information says nothing of how far
/// odometry may have drifted in between, so that starting from all it drops true closures wherever
/// drift is large; the check does know. All closures are judged either way. Closures that are
/// stated as all but exact are solved at a bound (stiffness.hpp).
///
/// Complexity: a few sparse factorisations, near linear in keyframes for chains; 10 to 30 times
/// that for GNC. Sources: Grisetti et al., A tutorial on graph-based SLAM, 2010; Agarwal et al.,
/// Dynamic covariance scaling, ICRA 2013; Suenderhauf and Protzel, Switchable constraints, IROS
/// 2012; Yang et al., Graduated non-convexity, RA-L 2020.
class PoseGraphOptimizer final : public Corrector {
 public:
  enum class Poses { automatic, se2, se3, sim3 };
  enum class Start { keyframes, odometry, chordal };
  enum class GncStart { all, consistent };

  struct Options {
    Poses group = Poses::automatic;
    Start start = Start::keyframes;
    Loss loss = Loss::none;
    std::optional<double> loss_width = std::nullopt;
    bool anneal = true;
    Gnc gnc = Gnc::off;
    GncStart gnc_start = GncStart::consistent;
    std::optional<double> inlier_chi2 = std::nullopt;
    double scale_sigma = 0.01;
    int max_iterations = 1000;
    double tolerance = 1e-14;
    bool rescale = false;
  };
  explicit PoseGraphOptimizer(const Options& options) : options_(options) {}

  /// Without closures, when keyframes are not connected, and SE(2) for what is not planar.
  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations` (linear solves), `cost_before`, `cost` (half the sum of squared
  /// Mahalanobis errors, or of losses), without a loss `chi2_per_dof`, with rescale `factor_t` and
  /// `factor_r` on standard deviations, and with GNC `gnc_rounds` and `closures_kept`. Throws
  /// std::runtime_error when there is no usable solution.
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
inline auto choices(PoseGraphOptimizer::GncStart) {
  return std::array{std::pair{"all", PoseGraphOptimizer::GncStart::all},
                    std::pair{"consistent", PoseGraphOptimizer::GncStart::consistent}};
}

template <class Visit>
void fields(PoseGraphOptimizer::Options& o, Visit visit) {
  visit("group", o.group, "what poses move in; auto: se2 if planar, sim3 if edges have scales");
  visit("start",
        o.start,
        "initial values: the keyframes, odometry chained from the first, or chordal relaxation");
  visit("loss", o.loss, "what a closure's squared error costs; dcs and switchable bound it");
  visit("loss_width",
        o.loss_width,
        "squared error where the loss bends [-]; none: the group's 99 % quantile for dcs and "
        "switchable, 1 for others",
        Above{0.0});
  visit("anneal",
        o.anneal,
        "dcs and switchable: also solve with a width that shrinks from the largest error, and keep "
        "the lower cost");
  visit("gnc", o.gnc, "graduated non-convexity: off, truncated least squares, Geman-McClure");
  visit("gnc_start", o.gnc_start, "closures believed first; consistent: those that agree, if any");
  visit("inlier_chi2",
        o.inlier_chi2,
        "squared error a true closure stays below [-]; none: the group's 99 % quantile",
        Above{0.0});
  visit("scale_sigma", o.scale_sigma, "deviation of an edge's log scale, sim3 [-]", Above{0.0});
  visit("max_iterations", o.max_iterations, "of each solve", Between{1, 10000});
  visit("tolerance", o.tolerance, "relative change of the cost that ends a solve [-]", Above{0.0});
  visit("rescale",
        o.rescale,
        "scale the odometry's covariances of translation and rotation by factors estimated from "
        "the loops (chains only)");
}

}  // namespace loopbench
