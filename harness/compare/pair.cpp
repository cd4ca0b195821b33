#include "harness/compare/pair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "harness/compare/signed_rank.hpp"
#include "metrics/numerics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// A sequence with this many groups can estimate its own typical difference.
constexpr std::size_t kFewestOfSequence = 5;

/// Log ratio to an error of zero in means, a factor of 1e-12.
constexpr double kZeroRatio = 27.6;

bool is_finite(double value) { return std::abs(value) < 0.1 * kNoRatio; }

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

/// Values by sequence.
std::map<std::size_t, std::vector<double>> split(const Pair& pair) {
  std::map<std::size_t, std::vector<double>> out;
  for (std::size_t i = 0; i < pair.values.size(); ++i) {
    out[pair.sequence[i]].push_back(pair.values[i]);
  }
  for (auto& [sequence, values] : out) std::ranges::sort(values);
  return out;
}

/// Sorted values whose sequences have the same typical value, the mean of all. The deviations are
/// larger by as much as they are too small for having been measured from an estimate.
std::vector<double> aligned(const Pair& pair) {
  const auto sequences = split(pair);
  std::map<std::size_t, double> middles;
  double common = 0.0;
  for (const auto& [sequence, values] : sequences) {
    if (sequences.size() < 2 || values.size() < kFewestOfSequence) return sorted(pair.values);
    const double middle = middles[sequence] = pseudo_median(values);
    if (!is_finite(middle)) return sorted(pair.values);
    common += middle * static_cast<double>(values.size()) / static_cast<double>(pair.values.size());
  }
  std::vector<double> out;
  for (const auto& [sequence, values] : sequences) {
    const auto n = static_cast<double>(values.size());
    for (const double value : values) {
      const double deviation = (value - middles[sequence]) * std::sqrt(n / (n - 1.0));
      out.push_back(is_finite(value) ? common + deviation : value);
    }
  }
  return sorted(out);
}

/// Median of differences of which some are +-kNoRatio.
double middle_of(const std::vector<double>& values) {
  const double middle = metrics::median(values);
  return is_finite(middle) ? middle : std::copysign(kNoRatio, middle);
}

void add(Pair& out, double value, std::size_t sequence) {
  out.values.push_back(value);
  out.sequence.push_back(sequence);
  ++(value < 0.0 ? out.wins : value > 0.0 ? out.losses : out.ties);
}

/// Sets the mean over groups of the mean over their runs on which both have a value.
void set_mean(Pair& out, std::vector<std::vector<double>> groups) {
  std::vector<double> means;
  for (std::vector<double>& of_group : groups) {
    for (double& difference : of_group) {
      if (is_finite(difference)) continue;
      difference = std::copysign(kZeroRatio, difference);
      out.has_zero = true;
    }
    if (!of_group.empty()) means.push_back(metrics::mean(of_group));
  }
  if (!means.empty()) out.mean = metrics::mean(means);
}

void test_signed_ranks(Pair& out) {
  const SignedRank ranks = signed_rank(out.values);
  out.lead = ranks.negative - ranks.positive;
  out.p = ranks.p;
  out.least_p = least_p(out.values.size());
}

/// Ties are counted for the method that is behind, which is the order that is worst for the claim.
void test_rank_sums(Pair& out) {
  out.lead = static_cast<double>(out.wins) - static_cast<double>(out.losses);
  const std::size_t against = out.values.size() - std::max(out.wins, out.losses);
  if (2 * against < out.values.size()) {
    out.p = std::min(1.0, 2.0 * rank_sum_tail(out.strata, against));
  }
  out.least_p = std::min(1.0, 2.0 * rank_sum_tail(out.strata, 0));
}

Pair of_paired_runs(const Levels& levels, std::size_t first, std::size_t second) {
  Pair out;
  std::vector<std::vector<double>> both(levels.groups());  // differences of runs with both values
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    std::vector<double> all;
    for (const std::size_t run : levels.runs_of(group)) {
      if (!levels.is_known(first, run) || !levels.is_known(second, run)) continue;
      const bool has_first = levels.has_value(first, run);
      const bool has_second = levels.has_value(second, run);
      if (!has_first && !has_second) continue;
      all.push_back(levels.difference(first, second, run));
      if (has_first && has_second) both[group].push_back(all.back());
    }
    if (!all.empty()) add(out, middle_of(all), levels.sequence_of(group));
  }
  set_mean(out, std::move(both));
  test_signed_ranks(out);
  return out;
}

/// Levels of a method by sequence. Equal ones are copies of one file and count once.
using Samples = std::map<std::size_t, std::vector<double>>;

Samples samples_of(const Levels& levels, std::size_t method) {
  Samples out;
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    const std::optional<double> level = levels.level(method, group);
    if (!level) continue;
    std::vector<double>& own = out[levels.sequence_of(group)];
    if (std::isnan(*level) || std::ranges::count(own, *level) == 0) own.push_back(*level);
  }
  return out;
}

/// Where most sequences have one run of either method, a sequence is an observation, as for paired
/// runs.
Pair of_independent_runs(const Levels& levels, std::size_t first, std::size_t second) {
  const Samples firsts = samples_of(levels, first);
  const Samples seconds = samples_of(levels, second);
  std::vector<Stratum> strata;
  std::map<std::size_t, std::vector<double>> differences;
  Pair out;
  std::vector<std::vector<double>> both;  // differences of two values, by sequence
  for (const auto& [sequence, of_first] : firsts) {
    const auto found = seconds.find(sequence);
    if (found == seconds.end()) continue;
    strata.push_back({of_first.size(), found->second.size()});
    both.emplace_back();
    for (const double a : of_first) {
      for (const double b : found->second) {
        differences[sequence].push_back(levels.difference(first, second, a, b));
        const bool has_both = !std::isnan(a) && !std::isnan(b);
        if (has_both) both.back().push_back(differences[sequence].back());
      }
    }
  }
  set_mean(out, std::move(both));
  const auto repeated =
      std::ranges::count_if(strata, [](const Stratum& one) { return one.pairs() > 1; });
  const bool has_runs = 2 * repeated >= std::ssize(strata);
  for (const auto& [sequence, of_sequence] : differences) {
    if (!has_runs) {
      add(out, middle_of(of_sequence), sequence);
      continue;
    }
    for (const double value : of_sequence) add(out, value, sequence);
  }
  if (!has_runs || strata.empty()) {
    test_signed_ranks(out);
  } else {
    out.strata = std::move(strata);
    test_rank_sums(out);
  }
  return out;
}

}  // namespace

double corrected(double p, std::size_t tests) {
  return tests == 1 ? p : -std::expm1(static_cast<double>(tests) * std::log1p(-p));
}

double level_of_one(double alpha, std::size_t tests) {
  return tests == 1 ? alpha : -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

bool Pair::is_first_ahead() const { return lead != 0.0 ? lead > 0.0 : mean && *mean < 0.0; }

bool Pair::is_contradicted() const {
  if (!mean || *mean == 0.0 || (*mean < 0.0) == is_first_ahead()) return false;
  const double beyond = is_first_ahead() ? -kNoRatio : kNoRatio;  // decided without a ratio
  const auto decided = static_cast<std::size_t>(std::ranges::count(values, beyond));
  return decided <= (is_first_ahead() ? losses : wins);
}

bool Pair::is_significant(double alpha, std::size_t tests) const {
  return p <= level_of_one(alpha, tests) && !is_contradicted();
}

std::optional<Interval> Pair::typical(double alpha) const {
  if (!strata.empty()) {
    const std::optional<std::size_t> outside = critical_pairs(strata, alpha);
    if (!outside) return std::nullopt;
    const std::vector<double> all = sorted(values);
    return Interval{middle_of(all), all[*outside], all[all.size() - 1 - *outside]};
  }
  std::optional<Interval> out = shift_interval(aligned(*this), alpha);
  if (!out) return out;
  if (p > alpha) {
    out->low = std::min(out->low, 0.0);
    out->high = std::max(out->high, 0.0);
  } else {  // ties and the differences between sequences can leave 0 inside
    (is_first_ahead() ? out->high : out->low) =
        is_first_ahead() ? std::min(out->high, 0.0) : std::max(out->low, 0.0);
  }
  out->estimate = std::clamp(out->estimate, out->low, out->high);
  return out;
}

std::vector<SequenceMean> Pair::by_sequence() const {
  std::vector<SequenceMean> out;
  std::map<std::size_t, std::vector<double>> sequences = split(*this);
  for (auto& [number, of_sequence] : sequences) {
    std::erase_if(of_sequence, [](double value) { return !is_finite(value); });
    if (of_sequence.empty()) continue;
    double observations = static_cast<double>(of_sequence.size());
    if (!strata.empty()) observations = std::sqrt(observations);  // runs, not pairs of them
    const double error = observations > 1.0
                             ? metrics::sample_deviation(of_sequence) / std::sqrt(observations)
                             : std::numeric_limits<double>::infinity();
    out.push_back({number, metrics::mean(of_sequence), error});
  }
  return out;
}

Pair compared(const Levels& levels, std::size_t first, std::size_t second) {
  Pair out = levels.is_paired() ? of_paired_runs(levels, first, second)
                                : of_independent_runs(levels, first, second);
  out.is_ratio = levels.is_ratio(first, second);
  return out;
}

}  // namespace loopbench::harness
