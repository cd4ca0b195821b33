/// Search for steps of the odometry that are wrong.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/placed_parts.hpp"
#include "methods/correctors/consensus/search.hpp"
#include "methods/correctors/consensus/step_candidates.hpp"
#include "methods/correctors/consensus/step_weights.hpp"

namespace loopbench::methods::consensus {

/// An explanation of some loops of a problem in which steps are freed, and the chain of its model.
template <class G>
struct StepExplanation {
  std::vector<FreedStep> freed;  ///< ascending
  std::unique_ptr<ReducedChain<G>> chain;
  std::optional<Explanation<G>> found;
  double log_prior = 0.0;   ///< of the freed steps
  std::size_t last = 0;     ///< keyframe where the step freed last begins
  double log_weight = 0.0;  ///< of it, log_step_weights()

  double score() const {
    return found ? found->score + log_prior : 0.0;  // all loops are uniform
  }
};

/// Frees one step after the other while that explains the loops better.
template <class G>
class StepSearch {
 public:
  /// One chain in twenty has a wrong step, as one closure in twenty slips; where in it, by
  /// log_step_weights().
  static constexpr double kLogWrong = -3.0;
  static constexpr std::size_t kMostFreed = 4;
  static constexpr std::size_t kTried = 2;  ///< candidates, for each step

  StepSearch(const Problem& problem, const std::vector<std::size_t>& closures, double log_needed)
      : problem_(problem), closures_(closures), log_needed_(log_needed) {
    edges_.assign(problem.keyframes.size() - 1, nullptr);
    for (const Edge& edge : problem.odometry) edges_[edge.from] = &edge;
  }

  void run(StepExplanation<G>& best) {
    while (best.freed.size() < kMostFreed) {
      std::optional<StepExplanation<G>> next = better(best);
      if (!next) return;
      best = std::move(*next);
    }
  }

 private:
  using Element = typename G::Element;
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;
  static constexpr std::array<double, 4> kInflations{
      10.0, 30.0, 100.0, std::numeric_limits<double>::infinity()};

  std::unique_ptr<ReducedChain<G>> chain(const std::vector<FreedStep>& freed) const {
    return std::make_unique<ReducedChain<G>>(placed_chain<G>(problem_, closures_, freed));
  }

  static std::vector<FreedStep> with(std::vector<FreedStep> freed, const FreedStep& step) {
    freed.push_back(step);
    std::ranges::sort(freed, {}, &FreedStep::from);
    return freed;
  }

  std::optional<StepExplanation<G>> better(const StepExplanation<G>& best) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (weight_.empty()) weight_ = log_step_weights(problem_);
    std::vector<FreedStep> open = best.freed;
    for (FreedStep& each : open) each.inflation = kInfinity;
    const std::unique_ptr<ReducedChain<G>> before = chain(open);
    std::optional<StepExplanation<G>> out;
    const double score = best.found ? best.found->score : 0.0;
    double least = best.score() + log_needed_;
    const LogFactors factors = best.found ? best.found->factors : LogFactors{};
    std::size_t tries = 0;
    for (const StepCandidate<G>& each : step_candidates(*before, factors, score)) {
      // Its steps are not weighted and its factors not fitted yet: both change little.
      if (++tries > kTried || !(each.found->score > score)) break;
      std::optional<StepExplanation<G>> tried = freed_in(each, best);
      if (!tried || !(tried->score() > least)) continue;
      if (!is_supported(*tried, best)) continue;
      least = tried->score();
      out = std::move(tried);
    }
    return out;
  }

  /// False closures of one place that agree with each other would agree with a wrong step, too, and
  /// so would any drift that all loops share. A step is therefore freed if it is unlike its
  /// neighbours, or if it makes loops of two places agree that did not before, or if loops of two
  /// places span it and others show that the rest of the chain drifts less, or the evidence is many
  /// times what is needed. It may not cost as many loops as it makes agree.
  bool is_supported(const StepExplanation<G>& with, const StepExplanation<G>& without) const {
    constexpr double kLogUnlike = -1.6094379124341003;  // a fifth of all weight
    constexpr std::size_t kLeast = 2;
    constexpr double kTimesNeeded = 4.0;
    if (!with.found) return false;
    const std::size_t step = with.last;
    std::vector<std::size_t> spanning, rescued;
    for (const std::size_t each : with.found->kept) {
      const Edge& loop = problem_.closures[closures_[each]];
      if (loop.from > step || loop.to <= step) continue;
      spanning.push_back(each);
      if (!without.found || !contains(without.found->kept, each)) rescued.push_back(each);
    }
    if (without.found) {
      const auto lost = std::ranges::count_if(
          without.found->kept, [&](std::size_t each) { return !contains(with.found->kept, each); });
      if (lost > 1 && static_cast<std::size_t>(lost) >= rescued.size()) return false;
    }
    if (with.log_weight > kLogUnlike) return spanning.size() >= kLeast;
    if (rescued.size() >= kLeast) return places(rescued) >= kLeast;
    const bool is_clear = with.score() > without.score() + kTimesNeeded * log_needed_;
    const bool have_others = with.found->kept.size() >= spanning.size() + kLeast;
    return places(spanning) >= kLeast && (have_others || is_clear);
  }

  static bool contains(const std::vector<std::size_t>& all, std::size_t one) {
    return std::ranges::find(all, one) != all.end();
  }

  /// Number of groups of loops whose begins and ends are within a twentieth of the chain.
  std::size_t places(const std::vector<std::size_t>& loops) const {
    const std::size_t near = std::max<std::size_t>(1, problem_.keyframes.size() / 20);
    const auto distance = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
    std::vector<const Edge*> firsts;
    for (const std::size_t each : loops) {
      const Edge& loop = problem_.closures[closures_[each]];
      const bool is_known = std::ranges::any_of(firsts, [&](const Edge* other) {
        return distance(other->from, loop.from) <= near && distance(other->to, loop.to) <= near;
      });
      if (!is_known) firsts.push_back(&loop);
    }
    return firsts.size();
  }

  struct Keyframes {
    std::size_t begin, end;
  };

  /// The best explanation with a step of the candidate's interval freed.
  std::optional<StepExplanation<G>> freed_in(const StepCandidate<G>& candidate,
                                             const StepExplanation<G>& best) {
    Search<G> search(*candidate.chain, SearchSettings{});
    search.run_from(candidate.found->factors, candidate.found->kept);
    if (!search.best()) return std::nullopt;
    const Explanation<G>& first = *search.best();
    FreedStep step = located(candidate, first);
    StepExplanation<G> out;
    out.freed = with(best.freed, step);
    out.log_prior = best.log_prior + log_prior(step);
    out.last = step.from;
    out.log_weight = weight_[step.from];
    out.chain = chain(out.freed);
    Search<G> again(*out.chain, SearchSettings{});
    again.run_from(first.factors, first.kept);
    out.found = refined(again);
    step.log_odds = out.score() - best.score();
    out.freed = with(best.freed, step);
    return out;
  }

  double log_prior(const FreedStep& step) const {
    return kLogWrong + weight_[step.from] - std::log(static_cast<double>(kInflations.size()));
  }

  /// Which step of the interval is wrong, and how much.
  FreedStep located(const StepCandidate<G>& candidate, const Explanation<G>& found) const {
    ReducedChain<G> exact = *candidate.chain;  // with the step's motion in the solution
    const std::size_t at = candidate.interval.begin;
    const Square unknown = exact.steps[at].unknown;
    exact.steps[at].unknown.setZero();
    exact.steps[at].measured =
        G::compose(G::inverse(found.model.poses()[at]), found.model.poses()[at + 1]);
    const CycleModel<G> model(exact, found.model.poses());
    const Keyframes interval{exact.keyframe[at], exact.keyframe[candidate.interval.end]};
    const auto spread = motion_of_end(model, found, at);
    // Poses by odometry from the end of the interval, backwards, and from its begin.
    std::vector<Element> after{found.model.poses()[candidate.interval.end]};
    for (std::size_t k = interval.end - 1; k > interval.begin; --k) {
      after.push_back(G::compose(after.back(), G::inverse(motion(k))));
    }
    FreedStep out{interval.begin, std::numeric_limits<double>::infinity()};
    double most = -std::numeric_limits<double>::infinity();
    Element before = found.model.poses()[at];
    for (std::size_t k = interval.begin; k < interval.end; ++k) {
      const Element end = G::compose(before, motion(k));
      const Element& moved = after[interval.end - 1 - k];
      const Element back = G::inverse(moved);
      const Square adjoint = G::adjoint(back);
      const Square spread_here = adjoint * spread.covariance * adjoint.transpose();
      const Tangent shift = adjoint * spread.shift;
      const Tangent error = G::log(G::compose(G::inverse(end), moved));
      for (const double inflation : kInflations) {
        const bool is_unknown = std::isinf(inflation);
        const Square own = is_unknown ? unknown : covariance(k, inflation, found.factors);
        const Tangent off = is_unknown ? shift : Tangent(error + shift);
        const double value =
            normal_density(off, Square(own + spread_here)).log_density + log_prior({k, inflation});
        if (!(value > most)) continue;
        most = value;
        out = {k, inflation};
      }
      before = end;
    }
    return out;
  }

  Element motion(std::size_t k) const { return G::from(measured(*edges_[k])); }

  Square covariance(std::size_t k, double inflation, const LogFactors& factors) const {
    constexpr int kFirst = kTranslation<G>;
    Tangent scale;
    scale.template head<kFirst>().setConstant(inflation * std::exp(factors.translation));
    scale.template tail<G::kDof - kFirst>().setConstant(inflation * std::exp(factors.rotation));
    return scale.asDiagonal() * inverse_of(G::information(*edges_[k], 1.0)) * scale.asDiagonal();
  }

  struct EndMotion {
    Tangent shift;      ///< of the rest of the chain, by the loops that span the step
    Square covariance;  ///< of it
  };

  /// What the loops say about a motion of everything after a step.
  static EndMotion motion_of_end(const CycleModel<G>& model,
                                 const Explanation<G>& found,
                                 std::size_t step) {
    constexpr Eigen::Index D = G::kDof;
    const auto size = D * static_cast<Eigen::Index>(found.kept.size());
    const JointLoops<G> joint(model, found.factors, found.kept);
    Eigen::MatrixXd spans = Eigen::MatrixXd::Zero(size, D);
    for (std::size_t i = 0; i < found.kept.size(); ++i) {
      const ChainLoop<G>& loop = model.chain().loops[found.kept[i]];
      if (loop.from > step || loop.to <= step) continue;
      spans.middleRows(D * static_cast<Eigen::Index>(i), D).setIdentity();
    }
    if (!joint.is_positive()) return {Tangent::Zero(), Square::Identity()};
    const Eigen::MatrixXd solved = joint.solve(spans);
    const Square precision = spans.transpose() * solved;
    const Square covariance = inverse_of(precision);
    return {covariance * (solved.transpose() * joint.rho()), covariance};
  }

  const Problem& problem_;
  const std::vector<std::size_t>& closures_;
  double log_needed_;
  std::vector<const Edge*> edges_;  ///< of each step
  std::vector<double> weight_;      ///< of each step, logarithmic
};

}  // namespace loopbench::methods::consensus
