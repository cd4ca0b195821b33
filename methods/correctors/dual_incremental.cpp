#include "methods/correctors/dual_incremental.hpp"

#include <algorithm>
#include <optional>

#include "methods/correctors/looped_chain.hpp"

namespace loopbench::methods {
namespace {

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
    equations_ = chain_->equations();
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
      if (has_moved && decrease <= options_.tolerance * before) return;
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

}  // namespace

std::unique_ptr<Incremental> DualIncremental::incremental(bool) const {
  return std::make_unique<GrowingDual>(options_);
}

}  // namespace loopbench::methods
