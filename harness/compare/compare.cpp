#include "harness/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/statistics/average.hpp"
#include "harness/statistics/effect_size.hpp"
#include "harness/statistics/friedman.hpp"
#include "harness/statistics/holm.hpp"
#include "harness/statistics/nemenyi.hpp"
#include "harness/statistics/ranks.hpp"
#include "harness/suggest.hpp"
#include "metrics/median.hpp"

namespace loopbench {
namespace {

using Values = std::vector<double>;

/// Methods without any value are dropped, then runs that some method lacks.
struct Common {
  std::vector<std::string> methods;
  std::vector<Values> values;  // [method][run]
};

std::string reasons(const std::vector<std::string>& status) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& why : status) {
    if (!why.empty()) ++counts[why];
  }
  std::string out;
  for (const auto& [why, count] : counts) {
    out += (out.empty() ? "" : ", ") + why + " " + std::to_string(count);
  }
  return out;
}

Common common(const Observations& all, Comparison& out) {
  std::vector<std::size_t> ranked;
  for (std::size_t m = 0; m < all.methods.size(); ++m) {
    const auto missing = static_cast<std::size_t>(std::ranges::count_if(
        all.values[m], [](const std::optional<double>& value) { return !value; }));
    const bool is_ranked = missing < all.runs.size();
    if (missing > 0) {
      out.gaps.push_back({all.methods[m], missing, reasons(all.status[m]), is_ranked});
    }
    if (is_ranked) ranked.push_back(m);
  }
  Common kept;
  for (const std::size_t m : ranked) kept.methods.push_back(all.methods[m]);
  kept.values.resize(ranked.size());
  std::set<std::string> sequences;
  for (std::size_t run = 0; run < all.runs.size(); ++run) {
    if (!std::ranges::all_of(ranked, [&](std::size_t m) { return all.values[m][run].has_value(); }))
      continue;
    for (std::size_t i = 0; i < ranked.size(); ++i) {
      kept.values[i].push_back(*all.values[ranked[i]][run]);
    }
    sequences.insert(all.sequences[run]);
    out.runs.push_back(all.runs[run]);
  }
  out.possible = all.runs.size();
  out.observations = kept.values.empty() ? 0 : kept.values[0].size();
  out.sequences = sequences.size();
  return kept;
}

void against_baseline(MethodVerdict& method,
                      const Values& values,
                      const Values& baseline,
                      const Comparison& of) {
  const CompareOptions& options = of.options;
  Differences pairs = paired_differences(values, baseline, options.tie);
  if (pairs.is_ratio) {
    const Resampled ratio = [&](std::span<const std::size_t> indices) {
      double sum = 0.0;
      for (const std::size_t i : indices) sum += pairs.values[i];
      return std::exp(sum / static_cast<double>(indices.size()));
    };
    method.has_interval = values.size() >= kFewestForInterval;
    if (method.has_interval) {
      method.ratio = bca_interval(
          values.size(), ratio, {options.resamples, 1.0 - options.alpha, options.seed});
    } else {
      const double estimate = std::exp(mean(pairs.values));
      method.ratio = Interval{estimate, estimate, estimate};
    }
  }
  // From here on positive means better.
  for (double& difference : pairs.values) {
    if (!of.higher_is_better && difference != 0.0) difference = -difference;
    ++(difference > 0.0 ? method.wins : difference < 0.0 ? method.losses : method.ties);
  }
  const SignedRank test = signed_rank(pairs.values);
  method.p = test.p;
  method.rank_biserial = rank_biserial(test);
  method.dz = cohen_dz(pairs.values);
}

/// p of every method against the one at `best`, corrected over all pairs of methods.
void against_best(std::vector<MethodVerdict>& methods,
                  const Common& kept,
                  std::size_t best,
                  double tie) {
  const std::size_t k = methods.size();
  std::vector<double> p;
  std::vector<std::size_t> place(k);
  for (std::size_t a = 0; a < k; ++a) {
    for (std::size_t b = a + 1; b < k; ++b) {
      if (a == best || b == best) place[a == best ? b : a] = p.size();
      const SignedRank test =
          signed_rank(paired_differences(kept.values[a], kept.values[b], tie).values);
      if (a == best || b == best) methods[a == best ? b : a].equals_best = test.count == 0;
      p.push_back(test.p);
    }
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t m = 0; m < k; ++m) methods[m].p_best = m == best ? 1.0 : adjusted[place[m]];
}

/// "a", "ab", ...: one letter for each group of ranks, and one of its own for who is in none.
void name_groups(std::vector<MethodVerdict>& sorted, double difference) {
  Values ranks;
  for (const MethodVerdict& method : sorted) ranks.push_back(method.average_rank);
  std::vector<std::vector<std::size_t>> groups = rank_groups(ranks, difference);
  for (std::size_t m = 0; m < sorted.size(); ++m) {
    const bool is_grouped = std::ranges::any_of(
        groups, [&](const auto& group) { return std::ranges::count(group, m) > 0; });
    if (!is_grouped) groups.push_back({m});
  }
  std::ranges::sort(groups);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::string name(1, static_cast<char>('a' + g % 26));
    if (g >= 26) name += std::to_string(g / 26);
    for (const std::size_t m : groups[g]) sorted[m].groups += name;
  }
}

void rank(Comparison& out, const Common& kept, std::size_t baseline) {
  const std::size_t k = kept.methods.size();
  const double sign = out.higher_is_better ? -1.0 : 1.0;
  std::vector<Values> blocks(out.observations, Values(k));
  for (std::size_t m = 0; m < k; ++m) {
    for (std::size_t run = 0; run < out.observations; ++run) {
      blocks[run][m] = sign * kept.values[m][run];
    }
  }
  const Friedman test = friedman(blocks, out.options.tie);
  out.friedman_p = test.p;
  out.critical_difference = critical_difference(k, out.observations, out.options.alpha);
  out.least_p = least_p(out.observations);
  out.least_p_holm = std::min(1.0, out.least_p * static_cast<double>(k - 1));
  std::vector<double> p;
  for (std::size_t m = 0; m < k; ++m) {
    MethodVerdict& method = out.methods.emplace_back();
    method.method = kept.methods[m];
    method.median = median(kept.values[m]);
    method.average_rank = test.average_ranks[m];
    against_baseline(method, kept.values[m], kept.values[baseline], out);
    if (m != baseline) p.push_back(method.p);
  }
  const std::vector<double> adjusted = holm(p);
  for (std::size_t m = 0, i = 0; m < k; ++m) {
    if (m != baseline) out.methods[m].p = adjusted[i++];
  }
  // Equal ranks (two variants that never differ): the one named first.
  const auto best = std::ranges::min_element(out.methods, {}, &MethodVerdict::average_rank);
  against_best(
      out.methods, kept, static_cast<std::size_t>(best - out.methods.begin()), out.options.tie);
  std::ranges::stable_sort(out.methods, {}, &MethodVerdict::average_rank);
  name_groups(out.methods, out.critical_difference);
}

Comparison compare_one(const Observations& all, const CompareOptions& options, bool higher) {
  Comparison out;
  out.kind = all.kind;
  out.options = options;
  out.higher_is_better = higher;
  const Common kept = common(options.over == Over::sequences ? by_sequence(all) : all, out);
  const auto baseline = std::ranges::find(kept.methods, options.baseline);
  if (out.observations == 0 || kept.methods.size() < 2 || baseline == kept.methods.end()) {
    return out;
  }
  rank(out, kept, static_cast<std::size_t>(baseline - kept.methods.begin()));
  return out;
}

}  // namespace

std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options) {
  std::vector<Record> fair = records;
  std::set<std::string> oracles;
  for (const Record& r : records) {
    if (r.oracle) oracles.insert(r.method);
  }
  std::erase_if(fair, [&](const Record& r) { return oracles.contains(r.method); });
  const std::vector<Observations> all = observations(fair, options.value);
  if (all.empty()) throw InputError("no score is left to compare");
  if (std::ranges::count(all[0].methods, options.baseline) == 0) {
    throw InputError("baseline: " + unknown_name("method", options.baseline, all[0].methods));
  }
  std::vector<Comparison> out;
  for (const Observations& table : all) {
    const Better way = table.kind.better;
    if (way == Better::neither || way == Better::target) continue;
    out.push_back(compare_one(table, options, way == Better::higher));
    out.back().oracles.assign(oracles.begin(), oracles.end());
  }
  if (out.empty()) {
    throw InputError("'" + metric_label(all[0].kind) +
                     "' describes: no value of it is better than another");
  }
  return out;
}

}  // namespace loopbench
