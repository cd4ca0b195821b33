/// Pose-graph optimisation, plain and robust: the field's standard answer.
#pragma once

#include "methods/method.hpp"
#include "methods/solvers/pose_graph_solver.hpp"

namespace loopbench {

/// Maximum likelihood over all keyframes: odometry and closures weighted by their information, as
/// solve_pose_graph() says. Closures may be false: then either one solve with a bounded `loss`, or
/// graduated non-convexity (`gnc`), which starts from all closures and lets go of those that stay
/// above `inlier_chi2`. Odometry is trusted. Edge.scale is ignored.
///
/// Complexity: a few sparse factorisations, near linear in keyframes for chains; 10 to 30 times
/// that for GNC. Sources: Grisetti et al., A tutorial on graph-based SLAM, 2010; Agarwal et al.,
/// Dynamic covariance scaling, ICRA 2013; Suenderhauf and Protzel, Switchable constraints, IROS
/// 2012; Yang et al., Graduated non-convexity, RA-L 2020.
class PoseGraphOptimizer final : public Corrector {
 public:
  enum class Start { keyframes, odometry };
  enum class Gnc { off, tls, gm };

  struct Options {
    Start start = Start::keyframes;
    Loss loss = Loss::none;
    double loss_width = 1.0;
    Gnc gnc = Gnc::off;
    double inlier_chi2 = 16.8;
    int max_iterations = 100;
    double tolerance = 1e-12;
  };
  explicit PoseGraphOptimizer(const Options& options) : options_(options) {}

  std::optional<std::string> declines(const Problem& problem) const override;

  /// Counts: `iterations` (linear solves), `cost_before`, `cost`, and with GNC `gnc_rounds` and
  /// `closures_kept`. Throws std::runtime_error when there is no usable solution.
  Trajectory correct(const Problem& problem, Report& report) const override;

 private:
  Options options_;
};

inline auto choices(PoseGraphOptimizer::Start) {
  return std::array{std::pair{"keyframes", PoseGraphOptimizer::Start::keyframes},
                    std::pair{"odometry", PoseGraphOptimizer::Start::odometry}};
}
inline auto choices(PoseGraphOptimizer::Gnc) {
  return std::array{std::pair{"off", PoseGraphOptimizer::Gnc::off},
                    std::pair{"tls", PoseGraphOptimizer::Gnc::tls},
                    std::pair{"gm", PoseGraphOptimizer::Gnc::gm}};
}

template <class Visit>
void fields(PoseGraphOptimizer::Options& o, Visit visit) {
  visit("start", o.start, "initial values: the keyframes, or odometry chained from the first");
  visit("loss", o.loss, "what a closure's squared error costs; dcs and switchable bound it");
  visit("loss_width", o.loss_width, "squared error where the loss bends [-]", Above{0.0});
  visit("gnc", o.gnc, "graduated non-convexity: off, truncated least squares, Geman-McClure");
  visit("inlier_chi2", o.inlier_chi2, "squared error a true closure stays below [-]", Above{0.0});
  visit("max_iterations", o.max_iterations, "of each solve", Between{1, 10000});
  visit("tolerance", o.tolerance, "relative change of the cost that ends a solve [-]", Above{0.0});
}

}  // namespace loopbench
