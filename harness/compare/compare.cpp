#include "harness/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "datasets/core/error.hpp"
#include "harness/base/suggest.hpp"
#include "harness/compare/selection.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// None where differences are no ratios, or most runs of one of the methods failed.
std::optional<Ratio> ratio_of(const Pair& pair, const KeptRuns& kept, const Comparison& of) {
  if (!pair.is_ratio || pair.values.empty()) return std::nullopt;
  const double sign = of.kind.better == metrics::Better::higher ? -1.0 : 1.0;
  const auto interval = pair.typical(level_of_one(of.options.alpha, of.tests));
  std::vector<double> sorted = pair.values;
  std::ranges::sort(sorted);
  const double estimate = interval ? interval->estimate : pseudo_median(sorted);
  if (std::abs(estimate) > 0.1 * kNoRatio) return std::nullopt;
  Ratio out;
  out.has_interval = interval.has_value();
  const double low = std::exp(sign * (interval ? interval->low : estimate));
  const double high = std::exp(sign * (interval ? interval->high : estimate));
  out.typical = {std::exp(sign * estimate), std::min(low, high), std::max(low, high)};
  if (pair.mean && !pair.has_zero) out.geometric_mean = std::exp(sign * *pair.mean);
  const auto sequences = pair.by_sequence();
  if (2 * sequences.size() > pair.values.size() || sequences.size() < 2) return out;
  for (const SequenceMean& one : sequences) {
    out.by_sequence.push_back({kept.sequences[one.sequence],
                               std::exp(sign * one.mean),
                               std::abs(one.mean) > 2.0 * one.error});
  }
  return out;
}

void add_baseline(MethodVerdict& method,
                  const Pair& pair,
                  const KeptRuns& kept,
                  const Comparison& of) {
  method.ratio = ratio_of(pair, kept, of);
  method.wins = pair.wins;
  method.losses = pair.losses;
  if (pair.is_ratio) method.deviation = pair.deviation();
  method.ties = pair.ties;
  const double p = corrected(pair.p, of.tests);
  if (of.can_show) method.p = p;
  method.is_contradicted = p <= of.options.alpha && pair.is_contradicted();
  method.beats_baseline = pair.is_first_ahead() && pair.is_significant(of.options.alpha, of.tests);
}

MethodVerdict counts_of(const Observations& all, const KeptRuns& kept, std::size_t method_index) {
  MethodVerdict out;
  out.method = all.methods[kept.methods[method_index]];
  std::vector<double> values;
  double covered = 0.0;
  std::vector<std::string> reasons;
  for (const std::size_t run : kept.runs) {
    const Observed& one = all.values[kept.methods[method_index]][run];
    if (one.value) values.push_back(*one.value);
    if (one.value) covered += one.coverage;
    if (one.is_loss) reasons.push_back(one.status);
  }
  for (const Observed& one : all.values[kept.methods[method_index]]) {
    if (one.status == to_text(Status::declined)) ++out.declines;
  }
  if (!values.empty()) out.coverage = covered / static_cast<double>(values.size());
  out.median = values.empty() ? std::nan("") : metrics::median(values);
  out.runs = values.size();
  out.fails = reasons.size();
  out.why_fails = counted(reasons);
  return out;
}

/// The leader, then by the typical ratio to the baseline; methods without one are last.
void sort_methods(std::vector<MethodVerdict>& methods, metrics::Better better) {
  const auto key = [&](const MethodVerdict& m) {
    const double sign = better == metrics::Better::higher ? -1.0 : 1.0;
    const auto behind = static_cast<double>(m.losses) - static_cast<double>(m.wins);
    const double ratio = m.ratio        ? sign * m.ratio->typical.estimate
                         : behind < 0.0 ? -kNoRatio
                                        : kNoRatio;
    return std::tuple(m.standing != Standing::leader, ratio, behind);
  };
  std::ranges::stable_sort(methods, {}, key);
}

Comparison compare_one(Observations& all, const CompareOptions& options) {
  Comparison out;
  out.kind = all.kind;
  out.options = options;
  out.oracles = all.oracles;
  out.copies = drop_duplicates(all);
  out.unstable.assign(all.unstable.begin(), all.unstable.end());
  const KeptRuns kept = select_runs(all, out);
  std::vector<std::string> names;
  for (const std::size_t m : kept.methods) names.push_back(all.methods[m]);
  const auto found = std::ranges::find(names, options.baseline);
  if (out.groups == 0 || names.size() < 2 || found == names.end()) return out;
  const auto baseline = static_cast<std::size_t>(found - names.begin());
  const Levels levels(kept.values, options.tie);
  const Ranking ranking = rank_methods(levels, {options.alpha, options.tie, options.relevant});
  out.tests = ranking.tests;
  out.can_show = ranking.can_show;
  out.groups_needed = ranking.groups_needed;
  for (std::size_t m = 0; m < names.size(); ++m) {
    MethodVerdict& method = out.methods.emplace_back(counts_of(all, kept, m));
    const Pair pair = compared(levels, m, baseline);
    out.is_ratio = out.is_ratio && pair.is_ratio;
    out.has_strata = out.has_strata || !pair.strata.empty();
    add_baseline(method, pair, kept, out);
    method.standing = ranking.standings[m];
    if (m != ranking.leader) method.from_leader = ratio_of(ranking.from_leader[m], kept, out);
  }
  sort_methods(out.methods, out.kind.better);
  const auto short_of_others = methods_with_less_coverage(out);
  out.is_best = ranking.is_best() && std::ranges::none_of(out.methods, [&](const MethodVerdict& m) {
                  return is_leading(m) && std::ranges::count(short_of_others, m.method) > 0;
                });
  return out;
}

}  // namespace

bool is_leading(const MethodVerdict& method) { return method.standing < Standing::behind; }

std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options) {
  return compare(observations(records, options.value), options);
}

std::vector<Comparison> compare(std::vector<Observations> all, const CompareOptions& options) {
  if (!has_direction(options.value)) {
    throw InputError("value: '" + options.value +
                     "' depends on the number of errors: no value is better than another; expected "
                     "rmse, mean, median, std, min or max");
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
    throw InputError("'" + metric_label(all[0].kind) +
                     "' is descriptive: no value is better than another");
  }
  return out;
}

}  // namespace loopbench::harness
