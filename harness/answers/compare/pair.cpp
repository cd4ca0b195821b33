#include "harness/answers/compare/pair.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/numerics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// The fewest groups for which an interval of 95 % exists.
constexpr std::size_t kFewestOfSequence = 6;

/// Log ratio to an error of zero in means, a factor of 1e-12.
constexpr double kZeroRatio = 27.6;

bool is_finite(double value) { return std::abs(value) < 0.1 * kNoRatio; }

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

/// Median of differences of which some are +-kNoRatio.
double middle_of(const std::vector<double>& values) {
  const double middle = metrics::median(values);
  return is_finite(middle) ? middle : std::copysign(kNoRatio, middle);
}

/// Adds the mean over a group's runs on which both methods have a value.
void add_mean(Pair& out, std::vector<double>& means, std::vector<double>& differences) {
  for (double& difference : differences) {
    if (is_finite(difference)) continue;
    difference = std::copysign(kZeroRatio, difference);
    out.has_zero = true;
  }
  if (!differences.empty()) means.push_back(metrics::mean(differences));
}

/// Returns the means of the groups.
std::vector<double> add_paired_runs(Pair& out,
                                    const Levels& levels,
                                    std::size_t first,
                                    std::size_t second) {
  std::vector<double> means, all, both;  // differences of a group, and those of two values
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    all.clear();
    both.clear();
    for (const std::size_t run : levels.runs_of(group)) {
      if (!levels.is_known(first, run) || !levels.is_known(second, run)) continue;
      const bool has_first = levels.has_value(first, run);
      const bool has_second = levels.has_value(second, run);
      if (!has_first && !has_second) continue;
      all.push_back(levels.difference(first, second, run));
      if (has_first && has_second) both.push_back(all.back());
    }
    if (all.empty()) continue;
    out.by_sequence[levels.sequence_of(group)].values.push_back(middle_of(all));
    add_mean(out, means, both);
  }
  return means;
}

/// Levels of a method by sequence. Equal ones are copies of one file and count once.
std::map<std::size_t, std::vector<double>> samples_of(const Levels& levels, std::size_t method) {
  std::map<std::size_t, std::vector<double>> out;
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    const std::optional<double> level = levels.level(method, group);
    if (!level) continue;
    std::vector<double>& own = out[levels.sequence_of(group)];
    if (std::isnan(*level) || std::ranges::count(own, *level) == 0) own.push_back(*level);
  }
  return out;
}

/// Returns the means of the sequences. Where most of them have one run of either method, a sequence
/// is an observation, as for paired runs.
std::vector<double> add_independent_runs(Pair& out,
                                         const Levels& levels,
                                         std::size_t first,
                                         std::size_t second) {
  const auto seconds = samples_of(levels, second);
  std::vector<double> means;
  std::size_t repeated = 0;
  for (const auto& [sequence, of_first] : samples_of(levels, first)) {
    const auto found = seconds.find(sequence);
    if (found == seconds.end()) continue;
    std::vector<double> both;  // differences of two values
    Sample& own = out.by_sequence[sequence];
    own.strata.push_back({of_first.size(), found->second.size()});
    repeated += own.strata[0].pairs() > 1 ? 1 : 0;
    for (const double a : of_first) {
      for (const double b : found->second) {
        own.values.push_back(levels.difference(first, second, a, b));
        if (!std::isnan(a) && !std::isnan(b)) both.push_back(own.values.back());
      }
    }
    add_mean(out, means, both);
  }
  if (2 * repeated >= out.by_sequence.size()) return means;
  for (auto& [sequence, own] : out.by_sequence) own = {{middle_of(own.values)}, {}};
  return means;
}

/// Ties are counted for the method that is behind, which is the order that is worst for the claim.
TestResult tested_rank_sums(const Sample& sample) {
  const auto is_negative = [](double value) { return value < 0.0; };
  const auto is_positive = [](double value) { return value > 0.0; };
  const auto wins = static_cast<std::size_t>(std::ranges::count_if(sample.values, is_negative));
  const auto losses = static_cast<std::size_t>(std::ranges::count_if(sample.values, is_positive));
  TestResult out{.lead = static_cast<double>(wins) - static_cast<double>(losses)};
  const std::size_t against = sample.values.size() - std::max(wins, losses);
  if (2 * against < sample.values.size()) {
    out.p = std::min(1.0, 2.0 * rank_sum_tail(sample.strata, against));
  }
  out.least_p = std::min(1.0, 2.0 * rank_sum_tail(sample.strata, 0));
  return out;
}

}  // namespace

double corrected(double p, std::size_t tests) {
  return tests == 1 ? p : -std::expm1(static_cast<double>(tests) * std::log1p(-p));
}

double level_of_one(double alpha, std::size_t tests) {
  return tests == 1 ? alpha : -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

double Sample::middle() const {
  return strata.empty() ? pseudo_median(sorted(values)) : middle_of(values);
}

std::optional<Interval> Sample::interval(double alpha) const {
  const std::vector<double> all = sorted(values);
  if (strata.empty()) return shift_interval(all, alpha);
  const std::optional<std::size_t> outside = critical_pairs(strata, alpha);
  if (!outside) return std::nullopt;
  return Interval{middle_of(all), all[*outside], all[all.size() - 1 - *outside]};
}

TestResult tested(const Sample& sample) {
  if (!sample.strata.empty()) return tested_rank_sums(sample);
  const SignedRank ranks = signed_rank(sample.values);
  return {ranks.negative - ranks.positive, ranks.p, least_p(sample.values.size())};
}

bool Pair::is_first_ahead() const { return lead != 0.0 ? lead > 0.0 : mean && *mean < 0.0; }

bool Pair::is_of_sequences() const {
  return by_sequence.size() > 1 && std::ranges::all_of(by_sequence, [](const auto& each) {
           const Sample& own = each.second;
           const std::size_t groups = own.strata.empty()
                                          ? own.values.size()
                                          : std::min(own.strata[0].first, own.strata[0].second);
           return groups >= kFewestOfSequence && is_finite(own.middle());
         });
}

double Pair::typical() const {
  if (!is_of_sequences()) return middle();
  double sum = 0.0;
  for (const auto& [sequence, own] : by_sequence) sum += own.middle();
  return sum / static_cast<double>(by_sequence.size());
}

bool Pair::is_contradicted() const {
  if (values.empty()) return false;
  const auto opposes = [&](double value) {
    return value != 0.0 && (value < 0.0) != is_first_ahead();
  };
  if (!(mean && opposes(*mean)) && !opposes(typical())) return false;
  const double beyond = is_first_ahead() ? -kNoRatio : kNoRatio;  // decided without a ratio
  const auto decided = static_cast<std::size_t>(std::ranges::count(values, beyond));
  return decided <= (is_first_ahead() ? losses : wins);
}

bool Pair::is_divided() const {
  bool has_better = false;
  bool has_worse = false;
  const double level = 0.05 / static_cast<double>(by_sequence.size());
  for (const auto& [sequence, own] : by_sequence) {
    const TestResult test = tested(own);
    if (test.p <= level) (test.lead > 0.0 ? has_better : has_worse) = true;
  }
  return has_better && has_worse;
}

bool Pair::is_significant(double level) const {
  return p <= level && !is_contradicted() && !is_divided();
}

std::optional<Interval> Pair::typical_interval(double alpha) const {
  std::optional<Interval> out;
  if (is_of_sequences()) {
    const double middle = typical();
    double below = 0.0;
    double above = 0.0;
    for (const auto& [sequence, own] : by_sequence) {
      const std::optional<Interval> one = own.interval(alpha);
      if (!one) return std::nullopt;
      below = std::hypot(below, one->estimate - one->low);
      above = std::hypot(above, one->high - one->estimate);
    }
    const auto sequences = static_cast<double>(by_sequence.size());
    out = Interval{middle, middle - below / sequences, middle + above / sequences};
  } else {
    out = interval(alpha);
  }
  if (!out) return out;
  if (p > alpha) {
    out->low = std::min(out->low, 0.0);
    out->high = std::max(out->high, 0.0);
  } else if (is_first_ahead() ? out->low > 0.0 : out->high < 0.0) {
    return std::nullopt;
  } else if (is_first_ahead()) {  // ties and the differences between sequences can leave 0 inside
    out->high = std::min(out->high, 0.0);
  } else {
    out->low = std::max(out->low, 0.0);
  }
  out->estimate = std::clamp(out->estimate, out->low, out->high);
  return out;
}

Pair compared(const Levels& levels, std::size_t first, std::size_t second) {
  Pair out;
  out.is_ratio = levels.is_ratio(first, second);
  const std::vector<double> means =
      (levels.is_paired() ? add_paired_runs : add_independent_runs)(out, levels, first, second);
  if (!means.empty()) out.mean = metrics::mean(means);
  for (const auto& [sequence, own] : out.by_sequence) {
    out.values.insert(out.values.end(), own.values.begin(), own.values.end());
    out.strata.insert(out.strata.end(), own.strata.begin(), own.strata.end());
  }
  for (const double value : out.values) {
    ++(value < 0.0 ? out.wins : value > 0.0 ? out.losses : out.ties);
  }
  static_cast<TestResult&>(out) = tested(out);
  return out;
}

}  // namespace loopbench::harness
