#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::harness {
namespace {

/// Share of alpha for comparisons of methods other than the baseline, if none with it is shown.
constexpr double kReserveShare = 0.1;

/// Share of alpha for the baseline beside a method that is ahead of all others.
constexpr double kBestShare = 0.8;

/// Two methods, and what shows that one is behind.
struct PairOutcome {
  std::size_t ahead = 0;
  std::size_t behind = 0;
  double p = 1.0;
  bool is_relevant = true;   ///< the typical difference
  bool can_lead = true;      ///< coverage and failures do not forbid that `ahead` is better
  bool by_failures = false;  ///< `behind` is shown to fail more often

  bool is_shown(double level) const { return by_failures || (can_lead && p <= level); }
  bool has(std::size_t method) const { return ahead == method || behind == method; }
};

/// The first method that each is equal to.
std::vector<std::size_t> first_equals(const Levels& levels) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < levels.methods(); ++m) {
    std::size_t first = 0;
    while (first < m && (out[first] != first || !levels.are_equal(m, first))) ++first;
    out.push_back(first);
  }
  return out;
}

class Ranking {
 public:
  Ranking(const Levels& levels, std::optional<std::size_t> baseline, Comparison& out)
      : out_(out), equals_(first_equals(levels)) {
    if (baseline) baseline_ = equals_[*baseline];
    for (std::size_t m = 0; m < equals_.size(); ++m) {
      if (equals_[m] == m) different_.push_back(m);
    }
    out.tests = std::max<std::size_t>(1, different_.size() - 1);
    level_ = level_of_one(out.options.alpha, out.tests);
    for (MethodVerdict& m : out.methods) m.level = level_;
    for (const std::size_t second : different_) {
      for (const std::size_t first : different_) {
        if (first < second) add(compared(levels, first, second), first, second);
      }
    }
    out.groups_needed = 1;
    while (corrected(least_p_of(out.groups_needed, strata_), out.tests) > out.options.alpha)
      ++out.groups_needed;
    out.is_independent = strata_ > 0;
  }

  void rank() {
    const bool has_best = out_.can_show && find_best();
    if (!has_best && baseline_ && out_.can_show) find_groups();
    for (std::size_t m = 0; m < equals_.size(); ++m) {
      out_.methods[m].is_worse = out_.methods[equals_[m]].is_worse;
      out_.methods[m].level = out_.methods[equals_[m]].level;
    }
    out_.is_best = has_best && std::ranges::any_of(out_.methods, &MethodVerdict::is_worse);
  }

 private:
  void add(const Pair& pair, std::size_t first, std::size_t second) {
    const RandomizationTest test = pair.test();
    const bool is_about_baseline = !baseline_ || first == baseline_ || second == baseline_;
    const double least = pair.groups > 0 ? test.least_p() : 1.0;
    if (is_about_baseline) {
      out_.can_show = out_.can_show || least <= level_;
      out_.common = std::max(out_.common, pair.groups);
    }
    if (!pair.is_paired) strata_ = std::max(strata_, pair.by_sequence.size());
    PairOutcome one{.ahead = first, .behind = second};
    if (pair.has_difference()) {
      if (test.typical() > 0.0) std::swap(one.ahead, one.behind);
      if (least <= out_.options.alpha) one.p = test.p();
      one.is_relevant =
          !pair.is_ratio || std::abs(test.typical()) >= std::log1p(out_.options.relevant);
    }
    const double failure_p = pair.failure_p();
    const std::size_t more = pair.first_fails_more() ? first : second;
    const bool is_shown = failure_p <= out_.options.alpha;
    one.can_lead = !pair.fails_beside(one.ahead == first) || (is_shown && more == one.behind);
    const auto pairs = static_cast<double>(different_.size() * (different_.size() - 1) / 2);
    one.by_failures = failure_p <= kReserveShare * out_.options.alpha / pairs &&
                      (more == one.behind || one.p > out_.options.alpha);
    if (one.by_failures && one.ahead == more) std::swap(one.ahead, one.behind);
    out_.can_show = out_.can_show || (is_about_baseline && one.by_failures);
    if (out_.methods[one.ahead].covers_less) one.can_lead = one.by_failures = false;
    outcomes_.push_back(one);
  }

  void set_worse(const PairOutcome& one) {
    if (one.is_relevant || one.by_failures) out_.methods[one.behind].is_worse = true;
  }

  /// The level for `best` of its comparison with `other`; without a baseline any method can be it.
  double level_for_best(std::size_t best, std::size_t other) const {
    if (!baseline_ || best == baseline_) return level_;
    if (other == baseline_) return std::max(level_, kBestShare * out_.options.alpha);
    return out_.options.alpha;
  }

  bool is_best(std::size_t method) const {
    return std::ranges::all_of(outcomes_, [&](const PairOutcome& one) {
      return !one.has(method) ||
             (one.ahead == method && one.is_shown(level_for_best(method, one.behind)));
    });
  }

  bool find_best() {
    const auto best = std::ranges::find_if(different_, [&](std::size_t m) { return is_best(m); });
    if (different_.size() < 2 || best == different_.end()) return false;
    for (const PairOutcome& one : outcomes_) {
      if (one.ahead != *best) continue;
      set_worse(one);
      if (one.behind == baseline_ && !one.is_shown(level_)) share_level(*best);
    }
    return true;
  }

  /// The comparison of the best method with the baseline gets most of alpha, the others the rest.
  void share_level(std::size_t best) {
    const double own = kBestShare * out_.options.alpha;
    const double rest = level_of_one((out_.options.alpha - own) / (1.0 - own), out_.tests - 1);
    for (const std::size_t m : different_) out_.methods[m].level = m == best ? own : rest;
  }

  /// Comparisons with the baseline first; the others get the share of alpha of those that are
  /// shown, with Holm's correction.
  void find_groups() {
    std::vector<PairOutcome> others;
    std::size_t shown = 0;
    for (const PairOutcome& one : outcomes_) {
      if (!one.has(*baseline_)) {
        others.push_back(one);
        continue;
      }
      if (one.p <= level_) ++shown;
      if (one.is_shown(level_)) set_worse(one);
    }
    const double share = static_cast<double>(shown) / static_cast<double>(out_.tests);
    const double alpha = out_.options.alpha * std::max(kReserveShare, share);
    std::ranges::stable_sort(others, {}, &PairOutcome::p);
    bool is_rejected = true;
    for (std::size_t i = 0; i < others.size(); ++i) {
      is_rejected = is_rejected && others[i].p <= alpha / static_cast<double>(others.size() - i);
      if (others[i].is_shown(is_rejected ? 1.0 : -1.0)) set_worse(others[i]);
    }
    if (std::ranges::none_of(different_, [&](std::size_t m) { return !out_.methods[m].is_worse; }))
      for (MethodVerdict& m : out_.methods) m.is_worse = false;  // in a circle: nothing is decided
  }

  Comparison& out_;
  std::vector<std::size_t> equals_;
  std::vector<std::size_t> different_;
  std::vector<PairOutcome> outcomes_;
  std::optional<std::size_t> baseline_;
  std::size_t strata_ = 0;
  double level_ = 0.0;
};

}  // namespace

void rank_methods(const Levels& levels, std::optional<std::size_t> baseline, Comparison& out) {
  Ranking(levels, baseline, out).rank();
}

void test_sequences(Comparison& c) {
  std::vector<SequenceRatio*> all;
  std::size_t sequences = 0;
  for (MethodVerdict& m : c.methods) {
    if (!m.ratio || m.method == c.options.baseline) continue;
    sequences = std::max(sequences, m.ratio->by_sequence.size());
    for (SequenceRatio& one : m.ratio->by_sequence) all.push_back(&one);
  }
  std::ranges::stable_sort(all, {}, &SequenceRatio::p);
  std::size_t left = c.tests * sequences;
  for (SequenceRatio* one : all) {
    if (one->p > c.options.alpha / static_cast<double>(std::max<std::size_t>(1, left))) break;
    one->is_clear = true;
    if (left > 0) --left;
  }
}

}  // namespace loopbench::harness
