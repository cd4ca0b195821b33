#include "harness/answers/compare/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/sweep/model/name_order.hpp"
#include "harness/sweep/text/suggest.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// The subset of a score's values on which methods can be compared.
struct KeptRuns {
  std::vector<std::size_t> methods;    ///< indices into the observations: methods with any value
  std::vector<std::size_t> runs;       ///< likewise
  GroupedValues values;                ///< values of these methods and runs
  std::vector<std::string> sequences;  ///< names by GroupedValues::sequence
};

/// Methods with a value on any run; missing values are recorded in `gaps`.
std::vector<std::size_t> ranked_methods(const Observations& all, Comparison& out) {
  std::vector<std::size_t> ranked;
  for (std::size_t m = 0; m < all.methods.size(); ++m) {
    std::map<std::string, std::size_t> reasons;
    Gap gap{all.methods[m], 0, "", true};
    for (const Observed& one : all.values[m]) {
      if (one.value) continue;
      ++reasons[one.status];
      ++gap.missing;
    }
    gap.is_ranked = gap.missing < all.runs.size();
    if (gap.is_ranked) ranked.push_back(m);
    if (reasons.empty()) continue;
    for (const auto& [why, count] : reasons) {
      gap.why += fmt::format("{}{} {}", gap.why.empty() ? "" : ", ", why, count);
    }
    out.gaps.push_back(std::move(gap));
  }
  return ranked;
}

std::size_t count(const std::vector<std::size_t>& group) {
  return group.empty() ? 0 : 1 + *std::ranges::max_element(group);
}

/// Runs on which two ranked methods have a value or failed (one, if runs are independent), and at
/// least one has a value, grouped by `out.options.over`. Records counts in `out`.
KeptRuns select_runs(const Observations& all, Comparison& out) {
  KeptRuns kept{ranked_methods(all, out), {}, {}, {}};
  NameOrder sequences;
  std::map<std::string, std::string> first_labels;  // of the sequences by recording
  std::set<std::string> same_recordings;
  out.is_paired = out.options.paired || !std::ranges::all_of(all.runs, &ObservedRun::is_of_files);
  const auto fewest = std::min<std::ptrdiff_t>(out.is_paired ? 2 : 1, std::ssize(kept.methods));
  std::set<std::string> measured;
  for (std::size_t run = 0; run < all.runs.size(); ++run) {
    const auto at = [&](std::size_t m) -> const Observed& { return all.values[m][run]; };
    const auto known = std::ranges::count_if(
        kept.methods, [&](std::size_t m) { return at(m).value || at(m).is_loss; });
    const bool has_value =
        std::ranges::any_of(kept.methods, [&](std::size_t m) { return at(m).value.has_value(); });
    if (known < fewest || !has_value) continue;
    kept.runs.push_back(run);
    const std::size_t sequence = sequences.index(sequence_key(all.runs[run]));
    const std::string& label = all.runs[run].sequence;
    if (sequence == kept.sequences.size()) kept.sequences.push_back(label);
    if (const std::string& key = all.runs[run].recording; !key.empty()) {
      const std::string& first = first_labels.emplace(key, label).first->second;
      if (label != first) same_recordings.insert(label + " of " + first);
    }
    kept.values.sequence.push_back(sequence);
    if (all.runs[run].has_oracle_closures) measured.insert(all.runs[run].sequence);
  }
  for (const std::size_t m : kept.methods) {
    std::vector<std::optional<double>>& row = kept.values.values.emplace_back();
    for (const std::size_t run : kept.runs) {
      const Observed& one = all.values[m][run];
      row.push_back(one.is_loss ? std::optional(kFailed) : one.value);
    }
  }
  kept.values.group = group_numbers(all, kept.runs, out.options.over == Over::sequences);
  kept.values.better = all.kind.better;
  kept.values.target = all.kind.target;
  kept.values.is_paired = out.is_paired;
  out.groups = count(kept.values.group);
  out.runs = kept.runs.size();
  out.possible = all.runs.size();
  out.sequences = kept.sequences.size();
  out.same_recordings.assign(same_recordings.begin(), same_recordings.end());
  out.oracle_closures.assign(measured.begin(), measured.end());
  return kept;
}

/// Whether a log ratio is that to a zero error.
bool is_beyond(double log_ratio) { return std::abs(log_ratio) > 0.9 * kZeroRatio; }

/// Of each sequence with a typical ratio, if there are several with several groups.
std::vector<SequenceRatio> sequence_ratios(const Pair& pair, const KeptRuns& kept, double sign) {
  std::vector<SequenceRatio> out;
  if (!pair.has_strata()) return out;
  for (const auto& [sequence, own] : pair.by_sequence) {
    const RandomizationTest test({own});
    if (is_beyond(test.typical())) continue;
    out.push_back({kept.sequences[sequence], std::exp(sign * test.typical()), test.p()});
  }
  return out;
}

/// None where differences are no ratios, or errors are zero.
std::optional<Ratio> ratio_of(const Pair& pair,
                              const KeptRuns& kept,
                              const Comparison& of,
                              double level) {
  if (!pair.is_ratio || pair.groups == 0) return std::nullopt;
  const double sign = of.kind.better == metrics::Better::higher ? -1.0 : 1.0;
  const RandomizationTest test = pair.test();
  if (is_beyond(test.typical())) return std::nullopt;
  const auto interval = test.interval(level);
  Ratio out;
  out.has_interval = interval && !is_beyond(interval->low) && !is_beyond(interval->high);
  const double low = std::exp(sign * (out.has_interval ? interval->low : test.typical()));
  const double high = std::exp(sign * (out.has_interval ? interval->high : test.typical()));
  out.typical = {std::exp(sign * test.typical()), std::min(low, high), std::max(low, high)};
  if (pair.mean && !pair.has_zero) out.geometric_mean = std::exp(sign * *pair.mean);
  out.by_sequence = sequence_ratios(pair, kept, sign);
  out.is_of_sequences = pair.has_strata();
  return out;
}

void add_baseline(MethodVerdict& method,
                  const Pair& pair,
                  const KeptRuns& kept,
                  const Comparison& of) {
  const double alpha = of.options.alpha;
  method.ratio = ratio_of(pair, kept, of, method.level);
  method.common = pair.runs;
  method.wins = pair.wins;
  method.losses = pair.losses;
  method.ties = pair.ties;
  if (!of.can_show) return;
  const RandomizationTest test = pair.test();
  const double p = pair.has_difference() ? test.p() : 1.0;
  const bool is_equal_share = method.level == level_of_one(alpha, of.tests);
  method.p = is_equal_share ? corrected(p, of.tests) : std::min(1.0, p * alpha / method.level);
  const double failure_p = pair.failure_p();
  method.fails_more =
      failure_p <= level_of_one(alpha, of.tests) && pair.first_fails_more();  // a claim
  const bool is_shown = failure_p <= alpha;  // enough to forbid one
  if (p > method.level) return;
  const bool is_ahead = test.typical() < 0.0;
  if (is_shown && pair.first_fails_more() == is_ahead) return;
  (is_ahead ? method.beats_baseline : method.is_beaten) = true;
}

MethodVerdict counts_of(const Observations& all, const KeptRuns& kept, std::size_t method_index) {
  MethodVerdict out;
  out.method = all.methods[kept.methods[method_index]];
  if (const auto own = all.parts.find(out.method); own != all.parts.end()) out.parts = own->second;
  out.is_stated = all.stated.contains(out.method);
  std::vector<double> values;
  double covered = 0.0;
  for (const std::size_t run : kept.runs) {
    const Observed& one = all.values[kept.methods[method_index]][run];
    if (one.value) values.push_back(*one.value);
    if (one.value) covered += one.coverage;
    out.fails += one.is_loss ? 1 : 0;
  }
  if (!values.empty()) out.coverage = covered / static_cast<double>(values.size());
  out.median = values.empty() ? std::nan("") : metrics::median(values);
  out.runs = values.size();
  return out;
}

/// The first place, then by the typical ratio to the baseline; methods without one are last.
void sort_methods(std::vector<MethodVerdict>& methods, metrics::Better better) {
  const auto key = [&](const MethodVerdict& m) {
    const double sign = better == metrics::Better::higher ? -1.0 : 1.0;
    const auto behind = static_cast<double>(m.losses) - static_cast<double>(m.wins);
    double ratio = std::copysign(std::numeric_limits<double>::infinity(), behind);
    if (m.ratio) ratio = sign * m.ratio->typical.estimate;
    return std::tuple(m.is_worse, ratio, behind);
  };
  std::ranges::stable_sort(methods, {}, key);
}

/// Sets all that does not depend on a baseline; drops duplicates.
KeptRuns ranked(Observations& all, Comparison& out) {
  out.kind = all.kind;
  out.oracles = all.oracles;
  out.copies = drop_duplicates(all);
  out.unstable.assign(all.unstable.begin(), all.unstable.end());
  KeptRuns kept = select_runs(all, out);
  if (out.groups == 0 || kept.methods.size() < 2) return kept;
  constexpr double kLess = 0.9;  // of the largest coverage
  double largest = 0.0;
  for (std::size_t m = 0; m < kept.methods.size(); ++m) {
    largest = std::max(largest, out.methods.emplace_back(counts_of(all, kept, m)).coverage);
  }
  for (MethodVerdict& m : out.methods) m.covers_less = m.coverage < kLess * largest;
  const MethodVerdict* const found = out.find(out.options.baseline);
  const auto baseline = found == nullptr
                            ? std::nullopt
                            : std::optional(static_cast<std::size_t>(found - out.methods.data()));
  rank_methods(Levels(kept.values, out.options.tie), baseline, out);
  return kept;
}

Comparison compare_one(Observations& all, const CompareOptions& options) {
  Comparison out;
  out.options = options;
  const KeptRuns kept = ranked(all, out);
  const MethodVerdict* const found = out.find(options.baseline);
  if (found == nullptr) {
    out.methods.clear();
    return out;
  }
  const auto baseline = static_cast<std::size_t>(found - out.methods.data());
  const Levels levels(kept.values, options.tie);
  for (std::size_t m = 0; m < out.methods.size(); ++m) {
    const Pair pair = compared(levels, m, baseline);
    out.is_ratio = out.is_ratio && pair.is_ratio;
    add_baseline(out.methods[m], pair, kept, out);
  }
  // Independent runs of a method differ among themselves, but it does not differ from itself.
  MethodVerdict& itself = out.methods[baseline];
  itself.ties += std::exchange(itself.wins, 0) + std::exchange(itself.losses, 0);
  if (itself.ratio) itself.ratio->typical = {1.0, 1.0, 1.0};
  itself.beats_baseline = itself.is_beaten = false;
  test_sequences(out);
  sort_methods(out.methods, out.kind.better);
  return out;
}

}  // namespace

Comparison standings(Observations all, const CompareOptions& options) {
  Comparison out;
  out.options = options;
  ranked(all, out);
  return out;
}

std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options) {
  return compare(observations(records, options.value), options);
}

std::vector<Comparison> compare(std::vector<Observations> all, const CompareOptions& options) {
  if (!has_direction(options.value)) {
    throw InputError(fmt::format(
        "value: '{}' depends on the number of errors: no value is better than another; expected {}",
        options.value,
        fmt::join(directed_statistics(), ", ")));
  }
  if (all.empty()) throw InputError("no scores to compare");
  if (std::ranges::count(all[0].methods, options.baseline) == 0) {
    throw InputError("baseline: " + unknown_name("method", options.baseline, all[0].methods));
  }
  std::vector<Comparison> out;
  for (Observations& table : all) {
    if (table.kind.better == metrics::Better::neither) continue;
    out.push_back(compare_one(table, options));
    table.values.clear();  // large
  }
  if (out.empty()) {
    throw InputError("'" + all[0].kind.metric_label() +
                     "' is descriptive, or its best value differs between cells: no value is "
                     "better than another");
  }
  return out;
}

}  // namespace loopbench::harness
