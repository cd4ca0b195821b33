/// Pose-graph optimisation with a Cholesky factorisation that is updated while data arrive.
#pragma once

#include "methods/correctors/chain.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/method.hpp"
#include "methods/solvers/incremental_smoother.hpp"

namespace loopbench::methods {

/// Maximum likelihood on a chain, as pose_graph without a robust loss (incremental_smoother.hpp).
/// Gauss-Newton without damping from the odometry: it is made for replays (`online +`), in which
/// closures arrive one by one and every update starts near the minimum. On a complete problem with
/// large drift it can end in another minimum than pose_graph.
class IncrementalPoseGraph final : public Corrector {
 public:
  using Options = IncrementalSettings;
  explicit IncrementalPoseGraph(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override {
    return rigid_loops_fault(problem);
  }

  /// Counts: `iterations`, `eliminations` (of poses, over all iterations), and with
  /// `robust: gate` `closures_kept`.
  Trajectory correct(const Problem& problem, Report& report) const override {
    return incremental(problem.planar)->update(complete(problem), report);
  }

  std::unique_ptr<Incremental> incremental(bool planar) const override {
    return incremental_smoother(planar, options_);
  }

 private:
  Options options_;
};

template <class Visit>
void fields(IncrementalSettings& o, Visit visit) {
  visit("tolerance",
        o.tolerance,
        "largest correction of a pose that is not relinearised [m], [rad]",
        GreaterThan{0.0});
  visit("decrease",
        o.decrease,
        "an update ends when another linearisation is expected to lower chi2 by less than this "
        "share of it",
        Between{0.0, 1.0});
  visit("max_iterations",
        o.max_iterations,
        "maximum number of linearisations per update",
        Between{1, 1000});
  visit("robust",
        o.robust,
        "false closures; gate: reject a closure that raises chi2 by more than the 99 % quantile of "
        "its distribution; graduated: weigh closures by a loss that becomes less and less convex");
}

}  // namespace loopbench::methods
