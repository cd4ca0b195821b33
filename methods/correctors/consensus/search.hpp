/// Search for the factors and the loops that explain the errors of a chain best.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/agreeing_loops.hpp"
#include "methods/correctors/consensus/factor_estimate.hpp"

namespace loopbench::methods::consensus {

/// One explanation of all loops: those that agree are true, the others outliers.
template <class G>
struct Explanation {
  LogFactors factors;
  std::vector<std::size_t> kept;  ///< in the order in which they were found to agree
  CycleModel<G> model;            ///< at poses that the kept loops correct
  double evidence = 0.0;          ///< log odds of the kept, and the prior of the factors
  double score = 0.0;             ///< evidence, and log odds of the best outlier density of others
};

/// Evidence and score at the factors and poses of the explanation; false: not positive definite.
template <class G>
bool evaluate(Explanation<G>& of) {
  Elimination<G> eliminated(of.model, of.factors);
  if (!eliminated.condition_on(of.kept)) return false;
  of.evidence = eliminated.log_odds() + log_prior(of.factors);
  of.score = of.evidence;
  std::vector<bool> is_kept(of.model.size(), false);
  for (const std::size_t each : of.kept) is_kept[each] = true;
  for (std::size_t a = 0; a < of.model.size(); ++a) {
    if (is_kept[a]) continue;
    of.score += outlier_density(of.model,
                                a,
                                eliminated.error(a),
                                eliminated.covariance(a),
                                eliminated.closure_variance()) -
                of.model.log_uniform();
  }
  return std::isfinite(of.score);
}

/// Finds the loops that agree anew, without any that is preset: loops that were kept before others
/// were known can exclude these. Replaces `of`, and returns true, if that explains all loops
/// better.
template <class G>
bool find_anew(Explanation<G>& of) {
  constexpr int kSteps = 2;
  if (of.kept.size() == of.model.size()) return false;
  Explanation<G> before = of, anew = of;
  anew.kept = agreeing_loops(anew.model, anew.factors, {}, 0);
  if (anew.kept.empty() || std::ranges::is_permutation(anew.kept, of.kept)) return false;
  for (Explanation<G>* each : {&before, &anew}) {
    for (int step = 0; step < kSteps; ++step) relinearise(each->model, each->factors, each->kept);
  }
  if (!evaluate(anew) || (evaluate(before) && anew.score <= before.score)) return false;
  of = std::move(anew);
  return true;
}

/// Drops kept loops that are more likely outliers given the other kept ones: in each pass those
/// whose log odds are at least half of the worst. Returns each of those left by the others, or
/// nothing if that is not known.
template <class G>
std::vector<LeftOut<G>> drop_outliers(Explanation<G>& of) {
  constexpr int kPasses = 6;
  const double closure_variance = std::exp(2.0 * of.factors.closures);
  for (int pass = 0; pass < kPasses && of.kept.size() > 2; ++pass) {
    const JointLoops<G> joint(of.model, of.factors, of.kept);
    if (!joint.is_positive()) break;
    std::vector<LeftOut<G>> without = joint.left_out();
    std::vector<double> log_odds;  // of an outlier
    for (std::size_t i = 0; i < of.kept.size(); ++i) {
      const LeftOut<G>& each = without[i];
      const double outlier =
          outlier_density(of.model, of.kept[i], each.error, each.covariance, closure_variance);
      log_odds.push_back(outlier - normal_density(each.error, each.covariance).log_density);
    }
    const double limit = std::max(0.0, 0.5 * *std::ranges::max_element(log_odds));
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < of.kept.size(); ++i) {
      if (!(log_odds[i] > limit)) rest.push_back(of.kept[i]);
    }
    if (rest.empty() || rest.size() == of.kept.size()) return without;
    of.kept = std::move(rest);
  }
  return {};
}

/// Factors on the odometry's deviations at which each loop alone has its expected error, in
/// octaves, ascending.
template <class G>
std::vector<double> single_loop_octaves(const CycleModel<G>& model) {
  constexpr double kLeast = -6.0, kMost = 16.0;
  std::vector<double> out;
  for (std::size_t a = 0; a < model.size(); ++a) {
    typename G::Square odometry =
        model.shared(model.translation_sums(), a, a) + model.shared(model.rotation_sums(), a, a);
    double low = kLeast, high = kMost;
    while (high - low > 0.25) {
      const double middle = 0.5 * (low + high);
      const typename G::Square covariance = std::exp2(2.0 * middle) * odometry + model.own(a);
      const bool is_too_small =
          normal_density(model.rho(a), covariance).squared > static_cast<double>(G::kDof);
      (is_too_small ? low : high) = middle;
    }
    out.push_back(low);
  }
  std::ranges::sort(out);
  return out;
}

/// Factors to start from: on a lattice of octaves from the loops that the odometry explains best to
/// those at `share` of all, at most `most` of them.
template <class G>
std::vector<LogFactors> starting_factors(const CycleModel<G>& model, double share, int most) {
  const std::vector<double> octaves = single_loop_octaves(model);
  const auto last = static_cast<std::size_t>(share * static_cast<double>(octaves.size() - 1));
  const double begin = std::floor(octaves.front());
  const double end = std::max(begin + 1.0, std::ceil(octaves[last]) + 1.0);
  const double step = std::max(1.0, std::ceil((end - begin) / static_cast<double>(most - 1)));
  std::vector<LogFactors> out;
  for (double at = begin; at < end + step; at += step) {
    out.push_back({at * std::log(2.0), at * std::log(2.0), 0.0});
  }
  return out;
}

struct SearchSettings {
  int starts = 8;
  std::size_t refined = 3;  ///< explanations that are iterated
  int rounds = 3;
};

/// Search of one chain, from any number of starts.
template <class G>
class Search {
 public:
  Search(const ReducedChain<G>& chain, const SearchSettings& settings)
      : open_(chain, chain.poses), settings_(settings) {}

  /// Finds the loops that agree from each of the starting factors, and iterates the best.
  void run() {
    std::vector<Explanation<G>> found;
    for (const LogFactors& start : starting_factors(open_, kStartShare, settings_.starts)) {
      if (auto each = first(start)) found.push_back(std::move(*each));
    }
    std::ranges::stable_sort(found, std::greater{}, &Explanation<G>::score);
    for (std::size_t i = 0; i < std::min(found.size(), settings_.refined); ++i) {
      iterate(std::move(found[i]));
    }
  }

  /// Iterates from loops that agree and the factors that fit them.
  void run_from(const LogFactors& factors, const std::vector<std::size_t>& kept) {
    constexpr int kSteps = 3;
    Explanation<G> out{factors, kept, open_};
    for (int step = 0; step < kSteps; ++step) relinearise(out.model, factors, kept);
    out.kept = agreeing_loops(out.model, factors, kept, kRelinearisations);
    if (!out.kept.empty() && fit(out, 0.7, kLeastStep)) iterate(std::move(out));
  }

  /// The explanation of the highest score; nullopt: no loop is likelier true than an outlier.
  const std::optional<Explanation<G>>& best() const { return best_; }

 private:
  static constexpr double kStartShare = 0.75;  // of the loops, whose factors are starts
  static constexpr double kLeastStep = 0.2;    // of the climb, in logarithms
  static constexpr int kRelinearisations = 12;

  /// The loops that agree under the factors, which are then fitted to them; nullopt: none, or those
  /// that another start found.
  std::optional<Explanation<G>> first(const LogFactors& start) {
    Explanation<G> out{start, {}, open_};
    out.kept = agreeing_loops(out.model, start, {}, kRelinearisations);
    if (out.kept.empty()) return std::nullopt;
    std::vector<std::size_t> sorted = out.kept;
    std::ranges::sort(sorted);
    if (std::ranges::find(seen_, sorted) != seen_.end()) return std::nullopt;
    seen_.push_back(std::move(sorted));
    if (!fit(out, 0.7, 0.5)) return std::nullopt;
    return out;
  }

  /// Fits the factors and the poses to the kept loops.
  static bool fit(Explanation<G>& of, double step, double least) {
    of.factors = climb(LoopLikelihood(of.model, of.kept), of.factors, step, least);
    relinearise(of.model, of.factors, of.kept);
    return evaluate(of);
  }

  /// Alternates between the loops that agree and the factors that fit them.
  void iterate(Explanation<G> of) {
    for (int round = 0; round < settings_.rounds; ++round) {
      if (!best_ || of.score > best_->score) best_ = of;
      const LogFactors before = of.factors;
      std::vector<std::size_t> found = agreeing_loops(of.model, of.factors, {}, 0);
      if (found.empty()) return;
      const bool is_same = std::ranges::is_permutation(found, of.kept);
      of.kept = std::move(found);
      if (!fit(of, 0.35, kLeastStep)) return;
      const double change = std::max({std::abs(of.factors.translation - before.translation),
                                      std::abs(of.factors.rotation - before.rotation),
                                      std::abs(of.factors.closures - before.closures)});
      if (is_same && change < kLeastStep) break;
    }
    if (!best_ || of.score > best_->score) best_ = std::move(of);
  }

  CycleModel<G> open_;
  SearchSettings settings_;
  std::vector<std::vector<std::size_t>> seen_;
  std::optional<Explanation<G>> best_;
};

/// The best explanation, without outliers among its loops, with factors fitted more finely.
template <class G>
std::optional<Explanation<G>> refined(const Search<G>& search) {
  std::optional<Explanation<G>> out = search.best();
  if (!out) return out;
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    drop_outliers(*out);
    const double step = round == 0 ? 0.175 : 0.0875;
    out->factors = climb(LoopLikelihood(out->model, out->kept), out->factors, step, 0.06);
    relinearise(out->model, out->factors, out->kept);
  }
  if (!evaluate(*out)) out.reset();
  return out;
}

}  // namespace loopbench::methods::consensus
