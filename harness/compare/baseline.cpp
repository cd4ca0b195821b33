#include "harness/compare/baseline.hpp"

#include <algorithm>
#include <set>

#include "harness/compare/observations.hpp"

namespace loopbench::harness {

Tolerance time_limit(double relative) {
  return {.where = {"metric=time"},
          .values = {"rmse"},
          .relative = relative,
          .absolute = 1.0,
          .tie = 0.1};
}

bool limits_time(const std::vector<Tolerance>& limits) {
  return std::ranges::any_of(limits, [](const Tolerance& limit) {
    return std::ranges::count(limit.where, "metric=time") > 0;
  });
}

bool is_dirty(const std::map<std::string, std::string>& build_summary) {
  const auto source = build_summary.find("source");
  return source != build_summary.end() && source->second.find("dirty") != std::string::npos;
}

std::string name(const GateCell& cell) { return run_name(cell) + " / " + cell.method; }

std::string name(const GateScore& score) {
  std::string out = metric_label(score);
  for (const std::string& word : {score.relation.text(), score.axis.text()}) {
    if (!word.empty()) out += " " + word;
  }
  return out + ", " + score.times + ", " + score.protocol;
}

namespace {

GateScore gate_score(const Record& r, const std::set<std::string>& statistics) {
  GateScore out{r, 0, {}};
  if (has_numbers(r.status)) {
    out.count = static_cast<std::int64_t>(r.statistics.count);
    for (const std::string& statistic : statistics) out.values[statistic] = value(r, statistic);
  } else {
    out.pairs = out.possible = 0;
  }
  return out;
}

}  // namespace

std::vector<GateCell> gate_cells(const std::vector<Record>& records,
                                 const std::vector<Tolerance>& limits) {
  std::set<std::string> statistics;
  for (const Tolerance& limit : limits) {
    for (const std::string& statistic : limit.values) {
      value(Record{}, statistic);  // rejects an unknown statistic even without records
      statistics.insert(statistic);
    }
  }
  std::vector<GateCell> out;
  std::map<std::int64_t, std::size_t> positions;
  for (const Record& r : records) {
    const auto [found, is_new] = positions.emplace(r.cell, out.size());
    if (is_new) {
      out.push_back({r, {}});
      if (!r.metric.empty()) out.back().status = Status::ok;  // a cell with scores has no failure
    }
    if (!r.metric.empty()) out[found->second].scores.push_back(gate_score(r, statistics));
  }
  return out;
}

}  // namespace loopbench::harness
