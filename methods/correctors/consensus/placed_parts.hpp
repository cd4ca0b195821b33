/// Starting poses of the parts of a chain that is broken by steps without odometry.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "methods/correctors/consensus/agreeing_loops.hpp"

namespace loopbench::methods::consensus {

/// Whether the step includes one without odometry.
template <class G>
bool is_unknown(const ChainStep<G>& step) {
  return step.unknown(0, 0) > 0.0;
}

/// Sets the motion of steps without odometry to that of the poses, with which they then agree.
template <class G>
void settle_unknown_steps(ReducedChain<G>& chain, const std::vector<typename G::Element>& poses) {
  for (std::size_t k = 0; k < chain.steps.size(); ++k) {
    if (!is_unknown<G>(chain.steps[k])) continue;
    chain.steps[k].measured = G::compose(G::inverse(poses[k]), poses[k + 1]);
  }
}

/// Moves each part to where most loops agree with one that joins it to the parts already placed,
/// the first of which is that of the first node: the linear model does not hold elsewhere.
/// O(joining loops (nodes + loops)). A part that no loop joins stays.
template <class G>
class PartPlacement {
 public:
  explicit PartPlacement(ReducedChain<G>& chain) : chain_(chain), part_(chain.poses.size(), 0) {
    for (std::size_t k = 0; k < chain.steps.size(); ++k) {
      part_[k + 1] = part_[k] + (is_unknown<G>(chain.steps[k]) ? 1 : 0);
    }
    is_placed_.assign(part_.back() + 1, false);
    is_placed_[0] = true;
  }

  void run() {
    for (bool progress = true; progress;) {
      progress = false;
      for (std::size_t part = 1; part < is_placed_.size(); ++part) {
        if (is_placed_[part] || !place(part)) continue;
        is_placed_[part] = progress = true;
      }
    }
    settle_unknown_steps(chain_, chain_.poses);
  }

 private:
  using Element = typename G::Element;

  bool joins(const ChainLoop<G>& loop, std::size_t part) const {
    const std::size_t a = part_[loop.from], b = part_[loop.to];
    return a != b && ((a == part && is_placed_[b]) || (b == part && is_placed_[a]));
  }

  /// Poses after the motion of the part that closes the loop.
  std::vector<Element> closed(const ChainLoop<G>& loop, std::size_t part) const {
    const Element& from = chain_.poses[loop.from];
    const Element& to = chain_.poses[loop.to];
    const bool moves_end = part_[loop.to] == part;
    const Element goal =
        moves_end ? G::compose(from, loop.measured) : G::compose(to, G::inverse(loop.measured));
    const Element motion = G::compose(goal, G::inverse(moves_end ? to : from));
    std::vector<Element> out = chain_.poses;
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (part_[k] == part) out[k] = G::compose(motion, out[k]);
    }
    return out;
  }

  /// Number of the part's joining loops that agree with one of them at poses that close it, with
  /// the odometry's deviations as stated and 8 times that.
  std::size_t supporters(std::size_t loop,
                         const std::vector<std::size_t>& joining,
                         const CycleModel<G>& model) const {
    std::size_t out = 0;
    for (const double factor : {1.0, 8.0}) {
      Elimination<G> eliminated(model, {std::log(factor), std::log(factor), 0.0});
      if (!eliminated.condition_on(loop)) continue;
      for (const std::size_t other : joining) {
        if (other == loop) continue;
        out += eliminated.density(other).squared < kLargestSquared<G> ? 1 : 0;
      }
    }
    return out;
  }

  bool place(std::size_t part) {
    std::vector<std::size_t> joining;
    for (std::size_t a = 0; a < chain_.loops.size(); ++a) {
      if (joins(chain_.loops[a], part)) joining.push_back(a);
    }
    std::optional<std::size_t> most;
    std::vector<Element> best;
    for (const std::size_t loop : joining) {
      std::vector<Element> poses = closed(chain_.loops[loop], part);
      ReducedChain<G> moved = chain_;
      settle_unknown_steps(moved, poses);
      const std::size_t count = supporters(loop, joining, CycleModel<G>(moved, poses));
      if (most && count <= *most) continue;
      most = count;
      best = std::move(poses);
    }
    if (most) chain_.poses = std::move(best);
    return most.has_value();
  }

  ReducedChain<G>& chain_;
  std::vector<std::size_t> part_;  ///< of each node
  std::vector<bool> is_placed_;    ///< of each part
};

/// The chain for some closures of the problem, with its parts placed.
template <class G>
ReducedChain<G> placed_chain(const Problem& problem,
                             std::span<const std::size_t> closures,
                             std::span<const FreedStep> freed = {}) {
  ReducedChain<G> out = reduced_chain<G>(problem, closures, freed);
  if (out.has_unknown) PartPlacement<G>(out).run();
  return out;
}

}  // namespace loopbench::methods::consensus
