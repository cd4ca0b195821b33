#include "harness/answers/compare/pair.hpp"

#include <algorithm>
#include <cmath>

#include "metrics/numerics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// Adds the mean over a group's runs.
void add_mean(Pair& out, std::vector<double>& means, const std::vector<double>& differences) {
  for (const double difference : differences) {
    out.has_zero = out.has_zero || (out.is_ratio && std::abs(difference) == kZeroRatio);
  }
  if (!differences.empty()) means.push_back(metrics::mean(differences));
}

void count_outcome(Pair& out, double difference) {
  if (difference == 0.0) {
    ++out.ties;
  } else {
    ++(difference < 0.0 ? out.wins : out.losses);
  }
}

/// Returns the means of the groups.
std::vector<double> add_paired_runs(Pair& out,
                                    const Levels& levels,
                                    std::size_t first,
                                    std::size_t second) {
  std::vector<double> means, both;  // differences of a group
  Stratum failures;
  for (std::size_t group = 0; group < levels.groups(); ++group) {
    both.clear();
    double failed = 0.0;  // runs on which only the first failed, minus those of the second
    for (const std::size_t run : levels.runs_of(group)) {
      if (!levels.is_known(first, run) || !levels.is_known(second, run)) continue;
      const bool has_first = levels.has_value(first, run);
      const bool has_second = levels.has_value(second, run);
      if (has_first && has_second) both.push_back(levels.difference(first, second, run));
      if (has_first == has_second) continue;
      ++(has_first ? out.second_fails : out.first_fails);
      failed += has_first ? -1.0 : 1.0;
    }
    if (failed != 0.0) failures.first.push_back(std::copysign(1.0, failed));
    if (both.empty()) continue;
    out.runs += both.size();
    const double difference = metrics::median(both);
    out.by_sequence[levels.sequence_of(group)].first.push_back(difference);
    count_outcome(out, difference);
    add_mean(out, means, both);
  }
  if (!failures.first.empty()) out.failures.push_back(std::move(failures));
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

/// 1 for each failure, 0 for each value; removes the failures. Returns their number.
std::size_t take_failures(std::vector<double>& levels, std::vector<double>& failures) {
  for (const double level : levels) failures.push_back(std::isnan(level) ? 1.0 : 0.0);
  return std::erase_if(levels, [](double level) { return std::isnan(level); });
}

/// Adds the differences of two samples to the larger one of their values, of which the differences
/// are those of the samples.
void add_samples(Stratum& own,
                 const std::vector<double>& a,
                 const std::vector<double>& b,
                 const auto& difference) {
  double reference = 0.0;
  for (const auto* values : {&a, &b}) {
    for (const double value : *values) {
      if (std::abs(value) > std::abs(reference)) reference = value;
    }
  }
  for (const double value : a) own.first.push_back(difference(value, reference));
  for (const double value : b) own.second.push_back(difference(value, reference));
}

/// Returns the means of the sequences. Where most of them have one run of either method, a sequence
/// is an observation, as for paired runs.
std::vector<double> add_independent_runs(Pair& out,
                                         const Levels& levels,
                                         std::size_t first,
                                         std::size_t second) {
  auto seconds = samples_of(levels, second);
  std::vector<double> means;
  std::size_t repeated = 0;
  for (auto& [sequence, of_first] : samples_of(levels, first)) {
    const auto found = seconds.find(sequence);
    if (found == seconds.end()) continue;
    std::vector<double> a = of_first;
    std::vector<double>& b = found->second;
    Stratum& failures = out.failures.emplace_back();
    out.first_fails += take_failures(a, failures.first);
    out.second_fails += take_failures(b, failures.second);
    if (a.empty() || b.empty()) continue;
    const auto difference = [&](double x, double y) {
      return levels.difference(first, second, x, y);
    };
    add_samples(out.by_sequence[sequence], a, b, difference);
    repeated += a.size() * b.size() > 1 ? 1 : 0;
    out.runs += a.size() + b.size();
    std::vector<double> both;
    for (const double x : a) {
      for (const double y : b) both.push_back(difference(x, y));
    }
    for (const double each : both) count_outcome(out, each);
    add_mean(out, means, both);
  }
  if (2 * repeated >= out.by_sequence.size()) return means;
  for (auto& [sequence, own] : out.by_sequence) own = {{typical_of(own)}};
  out.is_paired = true;
  return means;
}

}  // namespace

double corrected(double p, std::size_t tests) {
  return tests == 1 ? p : -std::expm1(static_cast<double>(tests) * std::log1p(-p));
}

double level_of_one(double alpha, std::size_t tests) {
  return tests == 1 ? alpha : -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

bool Pair::has_strata() const {
  std::size_t values = 0;
  for (const auto& [sequence, own] : by_sequence)
    values += std::max(own.first.size(), own.second.size());
  return by_sequence.size() > 1 && 2 * by_sequence.size() <= values;
}

RandomizationTest Pair::test() const {
  std::vector<Stratum> strata;
  const bool is_one = is_paired && !has_strata();
  for (const auto& [sequence, own] : by_sequence) {
    if (strata.empty() || !is_one) {
      strata.push_back(own);
    } else {
      strata[0].first.insert(strata[0].first.end(), own.first.begin(), own.first.end());
    }
  }
  return RandomizationTest(std::move(strata));
}

double Pair::failure_p() const {
  if (first_fails + second_fails == 0) return 1.0;
  return exchanged(failures, 0.0).p;
}

bool Pair::first_fails_more() const {
  double sum = 0.0;
  for (const Stratum& one : failures) {
    sum += metrics::mean(one.first) - (one.is_paired() ? 0.0 : metrics::mean(one.second));
  }
  return sum > 0.0;
}

bool Pair::fails_beside(bool is_first) const {
  const std::size_t own = is_first ? first_fails : second_fails;
  const bool are_runs_of_both = failures.empty() || failures.front().is_paired();
  return own > 0 && (are_runs_of_both || is_first == first_fails_more());
}

Pair compared(const Levels& levels, std::size_t first, std::size_t second) {
  Pair out;
  out.is_ratio = levels.is_ratio(first, second);
  out.is_paired = levels.is_paired();
  const std::vector<double> means =
      (levels.is_paired() ? add_paired_runs : add_independent_runs)(out, levels, first, second);
  if (!means.empty()) out.mean = metrics::mean(means);
  out.groups = out.wins + out.losses + out.ties;
  return out;
}

}  // namespace loopbench::harness
