/// Search, comparison with a rival and judgement of all closures of a problem (judgement.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/derived_closures.hpp"
#include "methods/correctors/consensus/judgement.hpp"
#include "methods/correctors/consensus/placed_parts.hpp"
#include "methods/correctors/consensus/repeated_closures.hpp"
#include "methods/correctors/consensus/search.hpp"
#include "methods/correctors/consensus/solution_check.hpp"
#include "methods/correctors/consensus/step_search.hpp"

namespace loopbench::methods::consensus {

/// ln 100: a false closure that can be anywhere exceeds it in one of a hundred cases.
inline constexpr double kLogNeeded = 4.605170185988091;

/// Largest spread of the log factor of the rotation at which it is stated as a number.
inline constexpr double kWellKnown = 0.2;

/// Closures in the search, whose cost grows with the cube of the rows of their covariance: with it,
/// 100 closures on 1,000 keyframes take about ten times the time of the solution.
template <class G>
inline constexpr std::size_t kSearched = G::kDof == 3 ? 32 : 20;

/// Closures that all others are compared with, likewise.
template <class G>
inline constexpr std::size_t kCore = G::kDof == 3 ? 100 : 50;

/// `most` of the closures, evenly spaced in their order, which is that of time.
inline std::vector<std::size_t> evenly_chosen(const std::vector<std::size_t>& closures,
                                              std::size_t most) {
  std::vector<std::size_t> out;
  const std::size_t count = std::min(closures.size(), most);
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(closures[(2 * i + 1) * closures.size() / (2 * count)]);
  return out;
}

/// Poses of a chain with more nodes: by odometry from the last node before that the other chain
/// has.
template <class G>
std::vector<typename G::Element> transferred(const ReducedChain<G>& to,
                                             const ReducedChain<G>& from,
                                             const std::vector<typename G::Element>& poses) {
  std::vector<typename G::Element> out;
  std::size_t at = 0, same = 0;  // index of the node in `from`, and in `to`
  for (std::size_t k = 0; k < to.keyframe.size(); ++k) {
    if (at + 1 < from.keyframe.size() && from.keyframe[at + 1] == to.keyframe[k]) ++at, same = k;
    const auto motion = G::compose(G::inverse(to.poses[same]), to.poses[k]);
    out.push_back(G::compose(poses[at], motion));
  }
  return out;
}

/// Judges the closures of one problem.
template <class G>
class Judge {
 public:
  explicit Judge(const Problem& problem)
      : problem_(problem), repeated_(repeated_closures(problem)) {
    out_.closures.resize(problem.closures.size());
    out_.evidence_needed = kLogNeeded;
    const std::vector<bool> is_derived = derived_closures(problem);
    for (std::size_t k = 0; k < is_derived.size(); ++k) {
      if (is_derived[k]) {
        out_.closures[k].finding = ClosureFinding::agrees;
      } else if (repeated_[k] == k) {
        measured_.push_back(k);
      }
    }
  }

  ClosureJudgement run() {
    if (measured_.empty()) {  // nothing contradicts the odometry
      decide_by(0);
      return out_;
    }
    const std::vector<std::size_t> chosen = evenly_chosen(measured_, kSearched<G>);
    StepExplanation<G> best;
    best.chain = std::make_unique<ReducedChain<G>>(placed_chain<G>(problem_, chosen));
    Search<G> search(*best.chain, SearchSettings{});
    search.run();
    best.found = refined(search);
    StepSearch<G>(problem_, chosen, kLogNeeded).run(best);
    out_.steps = best.freed;
    const ReducedChain<G>& chain = *best.chain;
    std::optional<Explanation<G>>& found = best.found;
    if (!found) return out_;
    std::optional<Explanation<G>> rival = rival_of(chosen, *found);
    if (rival && rival->evidence > found->evidence) {  // it may explain the others, too
      Search<G> again(chain, SearchSettings{});
      again.run_from(rival->factors, rival->kept);
      again.run_from(found->factors, found->kept);
      found = refined(again);
      if (!found) return out_;
      rival = rival_of(chosen, *found);
    }
    if (rival && rival->evidence > 0.0) out_.rival_evidence = rival->evidence;
    out_.evidence = found->evidence;
    const LogFactors& at = found->factors;
    set_factors(at);
    const LoopLikelihood likelihood(found->model, found->kept);
    out_.factors.is_rotation_known = rotation_spread(likelihood, at) < kWellKnown;
    if (chosen.size() == measured_.size()) {
      classify(found->model, at, found->kept, measured_);
    } else {
      extend({&chain, &chosen}, *found);
    }
    decide_by(found->kept.size());
    return out_;
  }

 private:
  void set_factors(const LogFactors& at) {
    out_.factors.translation = std::exp(at.translation);
    out_.factors.rotation = std::exp(at.rotation);
    out_.factors.closures = std::exp(at.closures);
  }

  /// The best explanation of the closures that are not kept; its own are indices in `chosen`.
  std::optional<Explanation<G>> rival_of(const std::vector<std::size_t>& chosen,
                                         const Explanation<G>& of) {
    std::vector<std::size_t> index, rest;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (std::ranges::find(of.kept, i) != of.kept.end()) continue;
      index.push_back(i);
      rest.push_back(chosen[i]);
    }
    if (rest.empty()) return std::nullopt;
    rest_ = placed_chain<G>(problem_, rest, out_.steps);
    Search<G> search(rest_, {.starts = 4, .refined = 2, .rounds = 1});
    search.run();
    std::optional<Explanation<G>> out = search.best();
    if (out) {
      for (std::size_t& each : out->kept) each = index[each];
    }
    return out;
  }

  /// A chain, and the closures of the problem that are its loops.
  struct Part {
    const ReducedChain<G>* chain;
    const std::vector<std::size_t>* closures;
  };

  /// Model of a chain with more loops, at the poses that `found` gives to a part of them. Replaces
  /// the kept loops by their indices among all.
  static CycleModel<G> widened(ReducedChain<G>& to,
                               const std::vector<std::size_t>& closures,
                               const Part& part,
                               const Explanation<G>& found,
                               std::vector<std::size_t>& kept) {
    constexpr int kSteps = 2;
    std::vector<typename G::Element> poses = transferred(to, *part.chain, found.model.poses());
    settle_unknown_steps(to, poses);
    CycleModel<G> model(to, std::move(poses));
    kept.clear();
    for (const std::size_t i : found.kept) {
      const auto at = std::ranges::lower_bound(closures, (*part.closures)[i]);
      kept.push_back(static_cast<std::size_t>(at - closures.begin()));
    }
    for (int step = 0; step < kSteps; ++step) relinearise(model, found.factors, kept);
    return model;
  }

  /// Adds the closures that were not in the search: to the core those that agree, fitting the
  /// factors again; then all others, each compared with the core alone.
  void extend(const Part& searched, const Explanation<G>& found) {
    std::vector<std::size_t> chosen = evenly_chosen(measured_, kCore<G>);
    chosen.insert(chosen.end(), searched.closures->begin(), searched.closures->end());
    std::ranges::sort(chosen);
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    ReducedChain<G> chain = reduced_chain<G>(problem_, chosen, out_.steps);
    std::vector<std::size_t> kept;
    Explanation<G> core{found.factors, {}, widened(chain, chosen, searched, found, kept)};
    core.kept = agreeing_loops(core.model, core.factors, kept, 0);
    if (core.kept.empty()) core.kept = kept;
    find_anew(core);
    const LoopLikelihood some(core.model, evenly_chosen(core.kept, 2 * kSearched<G>));
    core.factors = climb(some, core.factors, 0.35, 0.15);
    set_factors(core.factors);
    relinearise(core.model, core.factors, core.kept);
    std::vector<LeftOut<G>> without = drop_outliers(core);
    if (chosen.size() == measured_.size()) {
      classify(core.model, core.factors, core.kept, chosen, std::move(without));
      return;
    }
    full_ = reduced_chain<G>(problem_, measured_, out_.steps);
    const CycleModel<G> model = widened(full_, measured_, {&chain, &chosen}, core, kept);
    classify(model, core.factors, kept, chosen);
    drop_inconsistent<G>(problem_, full_.log_uniform, out_);
  }

  /// Judges each measured closure given those kept, or the others of them, which is `without` if it
  /// is known. Those that are not among `compared` closures can be kept as well.
  void classify(const CycleModel<G>& model,
                const LogFactors& factors,
                const std::vector<std::size_t>& kept,
                const std::vector<std::size_t>& compared,
                std::vector<LeftOut<G>> without = {}) {
    state_steps(model);
    std::vector<bool> is_kept(model.size(), false);
    if (without.empty()) {
      const JointLoops<G> joint(model, factors, kept);
      if (!joint.is_positive()) return;
      without = joint.left_out();
    }
    const double closure_variance = std::exp(2.0 * factors.closures);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      is_kept[kept[i]] = true;
      judge(model, kept[i], without[i].error, without[i].covariance, closure_variance);
      out_.closures[measured_[kept[i]]].finding = ClosureFinding::agrees;
    }
    if (kept.size() == model.size()) return;
    Elimination<G> eliminated(model, factors);
    if (!eliminated.condition_on(kept)) return;
    for (std::size_t a = 0; a < model.size(); ++a) {
      if (is_kept[a]) continue;
      const ErrorDensity inlier = eliminated.density(a);
      judge(model, a, eliminated.error(a), eliminated.covariance(a), closure_variance);
      JudgedClosure& closure = out_.closures[measured_[a]];
      const bool is_rest = !std::ranges::binary_search(compared, measured_[a]);
      if (is_rest && closure.log_odds > 0.0 && inlier.squared < kLargestSquared<G>) {
        closure.finding = ClosureFinding::agrees;
      }
    }
  }

  /// Errors of the odometry in the freed steps, at the poses of the model.
  void state_steps(const CycleModel<G>& model) {
    const std::vector<std::size_t>& keyframe = model.chain().keyframe;
    for (FreedStep& step : out_.steps) {
      const auto at = std::ranges::lower_bound(keyframe, step.from) - keyframe.begin();
      const auto k = static_cast<std::size_t>(at);
      const auto edge = std::ranges::lower_bound(problem_.odometry, step.from, {}, &Edge::from);
      const auto motion = G::compose(G::inverse(model.poses()[k]), model.poses()[k + 1]);
      const auto error = G::compose(G::inverse(G::from(measured(*edge))), motion);
      state_size(error, step);
    }
  }

  void judge(const CycleModel<G>& model,
             std::size_t a,
             const typename G::Tangent& error,
             const typename G::Square& covariance,
             double closure_variance) {
    JudgedClosure& closure = out_.closures[measured_[a]];
    const double outlier = outlier_density(model, a, error, covariance, closure_variance);
    closure.log_odds = normal_density(error, covariance).log_density - outlier;
    closure.finding =
        outlier > model.log_uniform() ? ClosureFinding::slipped : ClosureFinding::contradicts;
    // The error is a motion of the chain in the world; at the end of the closure:
    const typename G::Tangent gap =
        G::adjoint(G::inverse(model.poses()[model.chain().loops[a].to])) * error;
    state_size(G::exp(gap), closure);
  }

  /// Distance and angle of a motion.
  template <typename Motion, typename Item>
  static void state_size(const Motion& motion, Item& item) {
    const Pose off = G::to_scaled_pose(motion).pose;
    item.metres = off.translation.norm();
    item.degrees = log_so3(off.rotation).norm() * 180.0 / M_PI;
  }

  void decide_by(std::size_t kept) {
    for (std::size_t k = 0; k < repeated_.size(); ++k) {
      out_.closures[k] = out_.closures[repeated_[k]];
    }
    for (const JudgedClosure& each : out_.closures) {
      out_.agreeing += each.finding == ClosureFinding::agrees ? 1 : 0;
    }
    const double rival = std::max(0.0, out_.rival_evidence.value_or(0.0));
    const double lead = out_.evidence - rival;
    out_.outcome = ConsensusOutcome::decided;
    if (rival > 0.0 && lead < kLogNeeded) out_.outcome = ConsensusOutcome::rival;
    if (!measured_.empty() && out_.evidence < kLogNeeded) out_.outcome = ConsensusOutcome::few;
    if (out_.is_decided()) return;
    out_.steps.clear();
    const double each =
        std::max(1.0, out_.evidence / static_cast<double>(std::max<std::size_t>(1, kept)));
    out_.more_needed = static_cast<std::size_t>(std::ceil((kLogNeeded - lead) / each));
  }

  const Problem& problem_;
  std::vector<std::size_t> repeated_;  ///< closure that each one repeats
  std::vector<std::size_t> measured_;  ///< closures that neither repeat nor come from the odometry
  ReducedChain<G> full_, rest_;
  ClosureJudgement out_;
};

}  // namespace loopbench::methods::consensus
