#include "harness/answers/compare/derived.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "harness/answers/compare/levels.hpp"
#include "harness/sweep/model/record_columns.hpp"
#include "harness/sweep/model/where.hpp"

namespace loopbench::harness {
namespace {

bool is_gain_source(const Record& r) {
  return r.kind->metric == "ate" && r.kind->relation == "translation" && r.status == Status::ok;
}

/// The kind of a derived score for each kind that it is derived from.
class DerivedKinds {
 public:
  template <class Change>
  const Shared<ScoreKind>& of(const ScoreKind& source, Change change) {
    const auto [found, is_new] = kinds_.try_emplace(source);
    if (is_new) {
      ScoreKind kind = source;
      change(kind);
      found->second = std::move(kind);
    }
    return found->second;
  }

 private:
  std::map<ScoreKind, Shared<ScoreKind>> kinds_;
};

/// NaN if the baseline has zero error.
double gain(double value, double baseline) {
  if (baseline <= zero_floor(std::max(value, baseline))) return std::nan("");
  return 100.0 * (1.0 - value / baseline);
}

/// The first scores of each cell, protocol and times, by index.
std::vector<std::size_t> first_scores(const std::vector<Record>& records) {
  std::vector<std::size_t> out;
  std::set<std::tuple<std::int64_t, std::string, std::string>> seen;
  const Record* last = nullptr;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Record& r = records[i];
    const ScoreKind& kind = *r.kind;
    if (r.status != Status::ok || !r.has_score()) continue;
    const bool is_like_last = last != nullptr && last->cell->position == r.cell->position &&
                              last->kind->protocol == kind.protocol &&
                              last->kind->times == kind.times;
    last = &r;
    if (is_like_last) continue;
    if (seen.emplace(r.cell->position, kind.protocol, kind.times).second) out.push_back(i);
  }
  return out;
}

/// A score of a cell that is a single number: every statistic has this value.
struct CellScore {
  const char* metric;
  const char* label;
  const char* unit;
  metrics::Better better;
  double (*value)(const Record&);  ///< NaN: none
};

std::vector<Record> scores_of_cells(const std::vector<Record>& records, const CellScore& score) {
  DerivedKinds kinds;
  std::vector<Record> out;
  for (const std::size_t i : first_scores(records)) {
    const Record& r = records[i];
    const double x = score.value(r);
    if (std::isnan(x)) continue;
    Record& one = out.emplace_back(r);
    one.kind = kinds.of(*r.kind, [&](ScoreKind& own) {
      own = {.protocol = own.protocol,
             .protocol_version = own.protocol_version,
             .times = own.times,
             .metric = score.metric,
             .label = score.label,
             .relation = "",
             .axis = "",
             .unit = score.unit,
             .better = score.better};
    });
    for (const auto& each : metrics::kStatisticFields) one.statistics.*each.member = x;
    one.statistics.count = 1;
    one.statistics.std = 0.0;
    one.statistics.sse = x * x;
  }
  return out;
}

double milliseconds_of(const Record& r) { return r.cell->milliseconds(); }
double cpu_of(const Record& r) { return 1e3 * r.cell->cpu_seconds.value_or(std::nan("")); }
double memory_of(const Record& r) {
  return r.cell->peak_memory ? 1e-6 * static_cast<double>(*r.cell->peak_memory) : std::nan("");
}

constexpr CellScore kCosts[] = {{"cpu_ms", "cpu", "ms", metrics::Better::lower, cpu_of},
                                {"wall_ms", "wall", "ms", metrics::Better::lower, milliseconds_of},
                                {"memory_mb", "memory", "MB", metrics::Better::lower, memory_of}};

std::vector<Record> pair_counts(const std::vector<Record>& records) {
  return scores_of_cells(records, {"pairs", "", "", metrics::Better::neither, [](const Record& r) {
                                     return static_cast<double>(r.pairs);
                                   }});
}

}  // namespace

std::vector<Record> gains(const std::vector<Record>& records, const std::string& baseline) {
  using Place = std::tuple<SharedText, std::int64_t, ScoreKind>;
  std::map<Place, const metrics::Statistics*, std::less<>> base;
  const auto place = [](const Record& r) {
    return std::tie(r.cell->sequence, r.cell->repeat, *r.kind);
  };
  for (const Record& r : records) {
    if (is_gain_source(r) && r.cell->method == baseline) base.emplace(place(r), &r.statistics);
  }
  DerivedKinds kinds;
  std::vector<Record> out;
  for (const Record& r : records) {
    const auto found = is_gain_source(r) ? base.find(place(r)) : base.end();
    if (found == base.end()) continue;
    const metrics::Statistics& b = *found->second;
    Record g = r;
    g.kind = kinds.of(*r.kind, [&](ScoreKind& kind) {
      kind.metric = "gain";
      kind.label = r.kind->metric_label() == "ate" ? "" : "gain (" + r.kind->metric_label() + ")";
      kind.better = metrics::Better::higher;
      kind.unit = "%";
    });
    for (const auto& each : metrics::kStatisticFields) {
      g.statistics.*each.member = gain(r.statistics.*each.member, b.*each.member);
    }
    if (!std::isfinite(g.statistics.rmse)) {
      g.status = Status::declined;
      g.why = "the error of the baseline " + baseline + " is zero";
    }
    out.push_back(g);
  }
  return out;
}

std::vector<Record> changes(const std::vector<Record>& records, const std::string& baseline) {
  DerivedKinds kinds;
  std::vector<Record> out = gains(records, baseline);
  for (Record& r : out) {
    r.kind = kinds.of(*r.kind, [](ScoreKind& kind) {
      kind.metric = "change";
      if (!kind.label.empty()) kind.label.replace(0, std::string_view("gain").size(), "change");
      kind.better = metrics::Better::lower;
    });
    for (const auto& each : metrics::kStatisticFields)
      r.statistics.*each.member = 0.0 - r.statistics.*each.member;  // not -0
  }
  return out;
}

std::vector<Record> run_times(const std::vector<Record>& records) {
  return scores_of_cells(records, {"time", "", "ms", metrics::Better::lower, milliseconds_of});
}

namespace {

/// Whether a name of a score, or rules, are about a cost. Rules about cells are not: a label can
/// contain the name of a cost.
bool is_about_cost(const std::string& text, const CellScore& cost) {
  return std::ranges::any_of(split_rules(text), [&](const std::string& rule) {
    const std::string field = field_of_rule(rule);
    const auto is_of_cell = [&](const RecordColumn& each) {
      return each.is_of_cell && field == each.name;
    };
    if (std::ranges::any_of(kRecordColumns, is_of_cell)) return false;
    return rule == cost.label || rule.find(cost.metric) != std::string::npos ||
           rule.find(std::string("label=") + cost.label) != std::string::npos;
  });
}

}  // namespace

std::vector<Record> cost_scores(const std::vector<Record>& records,
                                const std::vector<std::string>& asked) {
  std::vector<Record> out;
  for (const CellScore& cost : kCosts) {
    const auto is_asked = [&](const std::string& text) { return is_about_cost(text, cost); };
    if (std::ranges::none_of(asked, is_asked)) continue;
    std::ranges::move(scores_of_cells(records, cost), std::back_inserter(out));
  }
  return out;
}

void add_derived(std::vector<Record>& records,
                 const std::string& baseline,
                 const std::vector<std::string>& asked) {
  std::vector<Record> derived = gains(records, baseline);
  std::ranges::move(pair_counts(records), std::back_inserter(derived));
  std::ranges::move(run_times(records), std::back_inserter(derived));
  const auto is_change = [](const std::string& text) {
    return text.find("change") != std::string::npos;
  };
  if (std::ranges::any_of(asked, is_change))
    std::ranges::move(changes(records, baseline), std::back_inserter(derived));
  std::ranges::move(cost_scores(records, asked), std::back_inserter(derived));
  std::ranges::move(derived, std::back_inserter(records));
}

}  // namespace loopbench::harness
