/// dual for data that arrive: the loop equations grow by the rows of each closure.
#pragma once

#include <memory>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/scale_drift.hpp"
#include "methods/method.hpp"

namespace loopbench::methods {

/// The minimum of Dual (dual.hpp), reached from the last one. A new closure adds six rows to the
/// Cholesky factor of A S A' + S_L, O((6 K)^2) instead of O((6 K)^3) for K closures. The rows of
/// earlier closures keep their linearisation as long as steps with them converge fast (Newton's
/// method with the exact gradient); otherwise, and after a withdrawal, the equations are assembled
/// again. Each step is O(keyframes + (6 K)^2).
///
/// There is no second start and no scale drift: on a complete problem with large drift, it can end
/// in another minimum than Dual.
class DualIncremental final : public Corrector {
 public:
  struct Options {
    int max_iterations = 100;
    double tolerance = 1e-12;
  };
  explicit DualIncremental(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override {
    return rigid_loops_fault(problem);
  }

  /// Counts: `iterations`, and `assemblies` of the equations from nothing.
  Trajectory correct(const Problem& problem, Report& report) const override {
    return incremental(problem.planar)->update(complete(problem), report);
  }

  std::unique_ptr<Incremental> incremental(bool planar) const override;

 private:
  Options options_;
};

template <class Visit>
void fields(DualIncremental::Options& o, Visit visit) {
  visit("max_iterations", o.max_iterations, "maximum number of steps per update", Between{1, 1000});
  visit("tolerance",
        o.tolerance,
        "convergence threshold: relative change of the cost [-]",
        Between{0.0, 1.0});
}

}  // namespace loopbench::methods
