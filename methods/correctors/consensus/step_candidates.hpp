/// Where a wrong step would make loops agree.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/placed_parts.hpp"
#include "methods/correctors/consensus/search.hpp"

namespace loopbench::methods::consensus {

/// Steps between neighbouring ends of loops, which the same loops span: these do not tell where
/// between them a motion is wrong by any amount.
struct StepInterval {
  std::size_t begin = 0;  ///< node
  std::size_t end = 0;    ///< node
  std::size_t seed = 0;   ///< the loop that most of those that span them agree with
  double log_odds = 0.0;  ///< estimate of those of all loops, with a wrong step in it [-]
  double gain = 0.0;      ///< estimate of their increase by it [-]
};

/// Log odds, over the uniform density, of pairs of loops that span a step of unknown motion: of one
/// given that the other closes. At the poses that it closes, their errors differ by those of the
/// steps that only one spans.
template <class G>
class SpanningPairs {
 public:
  SpanningPairs(const CycleModel<G>& open, const LogFactors& factors)
      : open_(open), sums_(open.step_sums(factors)) {
    const std::vector<ChainLoop<G>>& loops = open.chain().loops;
    const double variance = std::exp(2.0 * factors.closures);
    std::vector<typename G::Element> gap;
    for (const ChainLoop<G>& loop : loops) {
      const auto end = G::compose(open.poses()[loop.from], loop.measured);
      gap.push_back(G::compose(end, G::inverse(open.poses()[loop.to])));
    }
    pairs_.setZero(static_cast<Eigen::Index>(loops.size()),
                   static_cast<Eigen::Index>(loops.size()));
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const typename G::Square covariance = open.shared(sums_, i, i) + variance * open.own(i);
      alone_.push_back(log_odds(open.rho(i), covariance));
      const typename G::Square moved = G::adjoint(gap[i]);
      const typename G::Element back = G::inverse(gap[i]);
      for (std::size_t j = 0; j < loops.size(); ++j) {
        const bool share =
            std::max(loops[i].from, loops[j].from) < std::min(loops[i].to, loops[j].to);
        if (i == j || !share) continue;
        const typename G::Square after =
            between(loops[i].to, loops[j].to) + variance * (open.own(i) + open.own(j));
        const double value =
            log_odds(G::log(G::compose(gap[j], back)),
                     between(loops[i].from, loops[j].from) + moved * after * moved.transpose());
        pairs_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = std::max(0.0, value);
      }
    }
  }

  /// Sets seed and log odds of an interval: of the loops that span it, given the seed, and of the
  /// others, given the odometry.
  void estimate(StepInterval& of) const {
    std::vector<Eigen::Index> spanning;
    const std::vector<ChainLoop<G>>& loops = open_.chain().loops;
    double others = 0.0;
    for (std::size_t a = 0; a < loops.size(); ++a) {
      if (loops[a].from <= of.begin && loops[a].to >= of.end) {
        spanning.push_back(static_cast<Eigen::Index>(a));
      } else {
        others += std::max(0.0, alone_[a]);
      }
    }
    double most = 0.0, without = 0.0;
    for (const Eigen::Index i : spanning) {
      double sum = 0.0;
      for (const Eigen::Index j : spanning) sum += pairs_(i, j);
      without = std::max(without, sum + alone_[static_cast<std::size_t>(i)]);
      if (sum <= most) continue;
      most = sum;
      of.seed = static_cast<std::size_t>(i);
    }
    of.log_odds = most > 0.0 ? most + others : 0.0;
    of.gain = most - without;
  }

 private:
  double log_odds(const typename G::Tangent& error, const typename G::Square& covariance) const {
    const ErrorDensity at = normal_density(error, covariance);
    if (at.squared > kLargestSquared<G>) return -std::numeric_limits<double>::infinity();
    return at.log_density - open_.log_uniform();
  }

  typename G::Square between(std::size_t a, std::size_t b) const {
    return sums_[std::max(a, b)] - sums_[std::min(a, b)];
  }

  const CycleModel<G>& open_;
  std::vector<typename G::Square> sums_;
  std::vector<double> alone_;  ///< log odds of each loop, given the odometry
  Eigen::MatrixXd pairs_;      ///< of column given row, at least 0
};

/// A chain in which the motion of one step is unknown, and the loops that then agree.
template <class G>
struct StepCandidate {
  StepInterval interval;
  std::unique_ptr<ReducedChain<G>> chain;  ///< with the step from the begin of the interval unknown
  std::optional<Explanation<G>> found;
};

/// The candidate of an interval: everything after it moves to where its seed closes.
template <class G>
StepCandidate<G> step_candidate(const ReducedChain<G>& chain,
                                const StepInterval& interval,
                                const LogFactors& factors) {
  StepCandidate<G> out{interval, std::make_unique<ReducedChain<G>>(chain), std::nullopt};
  std::vector<typename G::Element>& poses = out.chain->poses;
  const ChainLoop<G>& seed = chain.loops[interval.seed];
  const auto end = G::compose(poses[seed.from], seed.measured);
  const auto motion = G::compose(end, G::inverse(poses[seed.to]));
  for (std::size_t k = interval.begin + 1; k < poses.size(); ++k) {
    poses[k] = G::compose(motion, poses[k]);
  }
  out.chain->has_unknown = true;
  out.chain->steps[interval.begin].unknown += unknown_covariance<G>(chain.log_uniform);
  settle_unknown_steps(*out.chain, poses);
  Explanation<G> found{factors, {}, CycleModel<G>(*out.chain, poses)};
  found.kept = agreeing_loops(found.model, factors, {}, 0);
  if (!found.kept.empty() && evaluate(found)) out.found = std::move(found);
  return out;
}

/// Those of the highest log odds, and of the highest gain.
inline std::vector<StepInterval> most_promising(std::vector<StepInterval> all) {
  constexpr std::size_t kEach = 2;
  std::vector<StepInterval> out;
  for (const auto by : {&StepInterval::gain, &StepInterval::log_odds}) {
    std::ranges::stable_sort(all, std::greater{}, by);
    const auto count = static_cast<std::ptrdiff_t>(std::min(all.size(), kEach));
    out.insert(out.end(), all.begin(), all.begin() + count);
    all.erase(all.begin(), all.begin() + count);
  }
  return out;
}

/// The intervals where a wrong step would explain most, best first. `factors` and `score` are those
/// of an explanation without it, whose factors may be too large: smaller ones are tried, too.
/// O(loops^3).
template <class G>
std::vector<StepCandidate<G>> step_candidates(const ReducedChain<G>& chain,
                                              const LogFactors& factors,
                                              double score) {
  constexpr double kLeastShare = 0.4;  // of the score without it, which estimates fall short of
  const CycleModel<G> open(chain, chain.poses);
  std::vector<std::size_t> ends;
  for (const ChainLoop<G>& loop : chain.loops) {
    ends.push_back(loop.from);
    ends.push_back(loop.to);
  }
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<StepCandidate<G>> out;
  const auto is_free = [&](std::size_t begin, std::size_t end) {
    const auto steps = chain.steps.begin();
    return std::any_of(steps + static_cast<std::ptrdiff_t>(begin),
                       steps + static_cast<std::ptrdiff_t>(end),
                       is_unknown<G>);
  };
  for (const double octaves : {0.0, -2.0, -4.0}) {
    const double by = octaves * std::log(2.0);
    const LogFactors level{factors.translation + by, factors.rotation + by, factors.closures};
    const SpanningPairs<G> pairs(open, level);
    std::vector<StepInterval> all;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      if (is_free(ends[k], ends[k + 1])) continue;
      all.push_back({ends[k], ends[k + 1], 0, 0.0, 0.0});
      pairs.estimate(all.back());
      if (!(all.back().log_odds > kLeastShare * score)) all.pop_back();
    }
    for (const StepInterval& each : most_promising(std::move(all))) {
      StepCandidate<G> candidate = step_candidate(chain, each, level);
      if (!candidate.found) continue;
      const auto same = std::ranges::find_if(
          out, [&](const StepCandidate<G>& other) { return other.interval.begin == each.begin; });
      if (same == out.end()) {
        out.push_back(std::move(candidate));
      } else if (candidate.found->score > same->found->score) {
        *same = std::move(candidate);
      }
    }
  }
  std::ranges::stable_sort(
      out, std::greater{}, [](const StepCandidate<G>& each) { return each.found->score; });
  return out;
}

}  // namespace loopbench::methods::consensus
