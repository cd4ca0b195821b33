/// dual for data that arrive: the loop equations grow by the rows of each closure.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
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
    int max_closures = 300;
  };
  explicit DualIncremental(const Options& options) : options_(options) {}

  std::string why_declined(const Problem& problem) const override {
    if (std::string fault = rigid_loops_fault(problem); !fault.empty()) return fault;
    return loops_fault(problem, options_.max_closures);
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
        "convergence threshold: expected relative change of the cost by another step [-]",
        Between{0.0, 1.0});
  visit("max_closures",
        o.max_closures,
        "maximum number of closures; the memory of their equations grows with its square",
        Between{1, 4000});
}

class GrowingDual final : public Incremental {
 public:
  explicit GrowingDual(const DualIncremental::Options& options) : options_(options) {}
  GrowingDual(const GrowingDual&) = delete;  // chain_ refers to known_
  GrowingDual& operator=(const GrowingDual&) = delete;

  Trajectory update(const Increment& added, Report& report) override {
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(known_.keyframes, added.keyframes);
    append(known_.odometry, added.odometry);
    append(known_.closures, added.closures);
    for (const Edge& closure : added.withdrawn) withdraw(closure);
    if (chain_) {
      chain_->grow();
    } else {
      chain_.emplace(known_, stated_noise_model(known_));
    }
    iterations_ = assemblies_ = 0;
    if (known_.closures.empty()) {
      chain_->set_errors(std::vector<Twist>(known_.odometry.size(), Twist::Zero()));
    } else {
      minimise();
    }
    report.count("iterations", iterations_);
    report.count("assemblies", assemblies_);
    return chain_->keyframes();
  }

 private:
  void withdraw(const Edge& closure) {
    std::vector<Edge>& closures = known_.closures;
    const auto is_it = [&](const Edge& other) { return is_same_measurement(closure, other); };
    const auto found = std::ranges::find_if(closures, is_it);
    if (found == closures.end()) return;
    if (chain_) chain_->remove_closure(static_cast<std::size_t>(found - closures.begin()));
    closures.erase(found);
    equations_.reset();
  }

  void assemble() {
    LoopEquations last;  // a million numbers: their memory is used again
    if (equations_) last = std::move(*equations_);
    equations_ = chain_->equations(std::move(last.jacobian));
    last.covariance.clear();
    equations_->covariance = std::move(last.covariance);
    ++assemblies_;
  }

  /// Steps with the equations that are known, and with new ones when that converges slowly.
  void minimise() {
    constexpr double kFast = 0.01;  // decrease of the cost, relative to that of the step before
    bool is_new = !equations_.has_value();
    if (is_new) {
      assemble();
    } else {
      chain_->extend(*equations_);
    }
    double decrease = 0.0;
    while (iterations_ < options_.max_iterations) {
      const double before = chain_->cost();
      const bool has_moved = is_new ? chain_->step_at(*equations_) : chain_->step_with(*equations_);
      if (!has_moved && is_new) return;
      iterations_ += has_moved ? 1 : 0;
      const double last = std::exchange(decrease, before - chain_->cost());
      // The decrease after this one is to it as it is to the one before.
      const double expected = decrease < last ? decrease * (decrease / last) : decrease;
      if (has_moved && expected <= options_.tolerance * before) return;
      const bool is_far = decrease > 0.5 * before || (last > 0.0 && decrease > kFast * last);
      is_new = !has_moved || is_far;
      if (is_new) assemble();
    }
  }

  DualIncremental::Options options_;
  Problem known_;
  std::optional<LoopedChain> chain_;
  std::optional<LoopEquations> equations_;
  int iterations_ = 0;  ///< of the current update
  int assemblies_ = 0;
};

inline std::unique_ptr<Incremental> DualIncremental::incremental(bool) const {
  return std::make_unique<GrowingDual>(options_);
}

}  // namespace loopbench::methods
