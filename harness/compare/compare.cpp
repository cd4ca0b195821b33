#include "harness/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/compare/selection.hpp"
#include "harness/text/suggest.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

void add_ratio(MethodVerdict& method, const PairedMethods& pair, const Comparison& of) {
  const std::optional<double> middle = mean_difference(pair);
  if (!of.is_ratio || !middle) return;
  const double sign = of.kind.better == metrics::Better::higher ? -1.0 : 1.0;
  const double estimate = std::exp(sign * *middle);
  method.ratio = Interval{estimate, estimate, estimate};
  method.why_no_interval = why_no_interval(pair.common);
  const auto found = mean_interval(pair.common, 1.0 - of.options.alpha);
  if (!found) {
    const std::size_t groups = pair.common.size();
    method.has_equal_ratios = groups >= kFewestForInterval && 2 * pair.ties < groups;
    return;
  }
  const double one = std::exp(sign * found->interval.low);
  const double other = std::exp(sign * found->interval.high);
  method.ratio = Interval{estimate, std::min(one, other), std::max(one, other)};
  method.has_interval = true;
}

void add_baseline(MethodVerdict& method, const PairedMethods& pair, const Comparison& of) {
  add_ratio(method, pair, of);
  method.wins = pair.wins;
  method.losses = pair.losses;
  method.ties = pair.ties;
  method.rank_biserial = -rank_biserial(signed_rank(pair.losses_last));
}

MethodVerdict counts_of(const Observations& all, const CommonRuns& kept, std::size_t method_index) {
  MethodVerdict out;
  out.method = all.methods[kept.methods[method_index]];
  std::vector<double> values;
  double covered = 0.0;
  std::vector<std::string> reasons;
  for (const std::size_t run : kept.runs) {
    const Observed& one = all.values[kept.methods[method_index]][run];
    if (one.value) values.push_back(*one.value);
    if (one.value) covered += one.coverage;
    if (!one.value) reasons.push_back(one.status);
  }
  if (!values.empty()) out.coverage = covered / static_cast<double>(values.size());
  out.median = values.empty() ? std::nan("") : metrics::median(values);
  out.runs = values.size();
  out.fails = reasons.size();
  out.why_fails = counted(reasons);
  return out;
}

void add_claims(Comparison& out,
                const Ranking& ranking,
                std::size_t method_index,
                std::size_t baseline) {
  MethodVerdict& method = out.methods.back();
  const std::size_t first = ranking.order.front();
  method.is_leader = method_index == first || ranking.equal[first][method_index];
  method.is_beaten_by_leader = ranking.beats[first][method_index];
  method.beats_baseline = ranking.beats[method_index][baseline];
  method.lowest_rank = ranking.lowest_rank(method_index);
  method.highest_rank = ranking.highest_rank(method_index);
  if (ranking.can_prove(out.options.alpha)) method.p = ranking.p[method_index][baseline];
}

Comparison compare_one(const Observations& all, std::size_t copies, const CompareOptions& options) {
  Comparison out;
  out.kind = all.kind;
  out.options = options;
  out.copies = copies;
  const CommonRuns kept = select_common(all, out);
  std::vector<std::string> names;
  for (const std::size_t m : kept.methods) names.push_back(all.methods[m]);
  const auto found = std::ranges::find(names, options.baseline);
  if (out.groups == 0 || names.size() < 2 || found == names.end()) return out;
  const auto baseline = static_cast<std::size_t>(found - names.begin());
  const Levels levels(kept.values, options.relevant);
  const Ranking ranking = rank_methods(kept.values, {options.alpha, options.relevant});
  const std::vector<std::string> shared = letters(ranking);
  out.is_best_proven = ranking.is_best_proven();
  out.is_ratio = levels.is_ratio();
  out.pairs = ranking.pairs;
  out.groups_needed = ranking.groups_needed;
  for (const std::size_t method_index : ranking.order) {
    out.methods.push_back(counts_of(all, kept, method_index));
    out.methods.back().letters = shared[method_index];
    add_baseline(out.methods.back(), paired(levels, method_index, baseline), out);
    add_claims(out, ranking, method_index, baseline);
  }
  return out;
}

/// Collects oracle_methods().
class OracleMethods {
 public:
  void add(const Record& r) {
    if (r.sequence == last_.sequence && r.repeat == last_.repeat && r.method == last_.method)
      return;
    last_ = {r.sequence, r.repeat, r.method};
    if (!r.oracle) fair_runs_.insert(run_name(r));
    if (r.oracle) runs_of_[r.method].insert(run_name(r));
  }

  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& [method, runs] : runs_of_) {
      const auto is_fair = [&](const std::string& run) { return fair_runs_.contains(run); };
      if (std::ranges::any_of(runs, is_fair)) out.push_back(method);
    }
    return out;
  }

 private:
  struct LastCell {
    SharedText sequence;
    std::int64_t repeat = -1;
    SharedText method;
  };

  LastCell last_;                    // records of one cell mostly follow each other
  std::set<std::string> fair_runs_;  // with a method that does not use the reference
  std::map<std::string, std::set<std::string>> runs_of_;
};

}  // namespace

std::vector<std::string> oracle_methods(const std::vector<Record>& records) {
  OracleMethods out;
  for (const Record& r : records) out.add(r);
  return out.names();
}

std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options) {
  return compare(
      [&](const auto& visit) {
        for (const Record& r : records) visit(r);
      },
      options);
}

std::vector<Comparison> compare(const RecordSource& records, const CompareOptions& options) {
  value(Record{}, options.value);  // rejects an unknown statistic
  if (!has_direction(options.value)) {
    throw InputError("value: '" + options.value +
                     "' depends on the number of errors: no value is better than another; expected "
                     "rmse, mean, median, std, min or max");
  }
  OracleMethods excluded;
  ObservationsBuilder everything(options.value);
  records([&](const Record& r) {
    excluded.add(r);
    everything.add(r);
  });
  const std::vector<std::string> oracles = excluded.names();
  std::vector<Observations> all = everything.build();
  if (!oracles.empty()) {
    all.clear();
    ObservationsBuilder fair(options.value);
    records([&](const Record& r) {
      if (std::ranges::count(oracles, r.method.text()) == 0) fair.add(r);
    });
    all = fair.build();
  }
  if (all.empty()) throw InputError("no scores to compare");
  if (std::ranges::count(all[0].methods, options.baseline) == 0) {
    throw InputError("baseline: " + unknown_name("method", options.baseline, all[0].methods));
  }
  std::vector<Comparison> out;
  for (Observations& table : all) {
    if (table.kind.better == metrics::Better::neither) continue;
    const std::size_t copies = drop_duplicates(table);
    out.push_back(compare_one(table, copies, options));
    out.back().oracles = oracles;
    table.values.clear();  // large
  }
  if (out.empty()) {
    throw InputError("'" + metric_label(all[0].kind) +
                     "' is descriptive: no value is better than another");
  }
  return out;
}

}  // namespace loopbench::harness
