#include "harness/gate/baseline.hpp"

#include <algorithm>
#include <set>

namespace loopbench {

Tolerance time_limit(double relative) {
  return {.where = {"metric=time"}, .relative = relative, .absolute = 1.0, .tie = 0.1};
}

bool limits_time(const std::vector<Tolerance>& limits) {
  return std::ranges::any_of(limits, [](const Tolerance& limit) {
    return std::ranges::count(limit.where, "metric=time") > 0;
  });
}

std::string name(const GateCell& cell) {
  const std::string repeat =
      cell.repeat == 0 ? "" : " (repeat " + std::to_string(cell.repeat) + ")";
  return cell.sequence + repeat + " / " + cell.method;
}

std::string name(const GateScore& score) {
  std::string out = score.metric;
  for (const std::string& word : {score.relation, score.axis}) {
    if (!word.empty()) out += " " + word;
  }
  return out + ", " + score.times + ", " + score.protocol;
}

Record as_record(const GateCell& cell, const GateScore& score) {
  Record out;
  out.sequence = cell.sequence;
  out.repeat = cell.repeat;
  out.method = cell.method;
  out.protocol = score.protocol;
  out.times = score.times;
  out.metric = score.metric;
  out.relation = score.relation;
  out.axis = score.axis;
  out.unit = score.unit;
  out.status = score.status;
  out.better = score.better;
  return out;
}

std::vector<GateCell> gate_cells(const std::vector<Record>& records,
                                 const std::vector<Tolerance>& limits) {
  std::set<std::string> statistics;
  for (const Tolerance& limit : limits) {
    value(Record{}, limit.value);  // refuses an unknown one even when there are no records
    statistics.insert(limit.value);
  }
  std::vector<GateCell> out;
  std::map<std::int64_t, std::size_t> places;
  for (const Record& r : records) {
    const auto [found, is_new] = places.emplace(r.cell, out.size());
    if (is_new) out.push_back({r.sequence, r.repeat, r.method, "ok", {}});
    GateCell& cell = out[found->second];
    if (r.metric.empty()) {
      cell.status = r.status;
      continue;
    }
    GateScore score{r.protocol,
                    r.times,
                    metric_label(r),
                    r.relation,
                    r.axis,
                    r.unit,
                    r.status,
                    0,
                    {},
                    r.better};
    if (r.status == "ok") {
      score.pairs = r.pairs;
      for (const std::string& statistic : statistics) score.values[statistic] = value(r, statistic);
    }
    cell.scores.push_back(std::move(score));
  }
  return out;
}

}  // namespace loopbench
