#include "harness/compare/observations.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "harness/compare/name_order.hpp"
#include "harness/statistics/average.hpp"

namespace loopbench {
namespace {

auto table_kind(const Record& r) {
  return std::tie(r.protocol, r.times, r.metric, metric_label(r), r.relation, r.axis);
}
using TableKind =
    std::tuple<std::string, std::string, std::string, std::string, std::string, std::string>;

}  // namespace

std::string run_name(const Record& r) {
  return r.repeat == 0 ? r.sequence : r.sequence + " (repeat " + std::to_string(r.repeat) + ")";
}

std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value_name) {
  NameOrder methods;
  NameOrder runs;
  std::vector<std::string> sequences;
  std::map<TableKind, std::size_t> tables;
  std::vector<Observations> out;
  for (const Record& r : records) {
    methods.index(r.method);
    if (runs.index(run_name(r)) == sequences.size()) sequences.push_back(r.sequence);
    if (r.metric.empty() || !tables.emplace(table_kind(r), out.size()).second) continue;
    out.emplace_back().kind = r;
  }
  for (Observations& table : out) {
    table.methods = methods.names();
    table.runs = runs.names();
    table.sequences = sequences;
    table.values.assign(table.methods.size(), {});
    table.status.assign(table.methods.size(), {});
    for (std::size_t m = 0; m < table.methods.size(); ++m) {
      table.values[m].resize(table.runs.size());
      table.status[m].assign(table.runs.size(), "not run");
    }
  }
  const auto put = [&](Observations& table, const Record& r) {
    const std::size_t m = methods.index(r.method);
    const std::size_t run = runs.index(run_name(r));
    const bool is_ok = !r.metric.empty() && r.status == "ok";
    if (is_ok) table.values[m][run] = value(r, value_name);
    table.status[m][run] = is_ok ? "" : r.status == "ok" ? "not judged" : r.status;
  };
  for (const Record& r : records) {
    if (!r.metric.empty()) {
      put(out[tables.at(table_kind(r))], r);
    } else {
      for (Observations& table : out) put(table, r);
    }
  }
  return out;
}

Observations by_sequence(const Observations& by_run) {
  NameOrder order;
  for (const std::string& sequence : by_run.sequences) order.index(sequence);
  Observations out{by_run.kind, by_run.methods, order.names(), order.names(), {}, {}};
  for (std::size_t m = 0; m < by_run.methods.size(); ++m) {
    std::vector<std::vector<double>> repeats(order.names().size());
    std::vector<std::string> status(order.names().size());
    for (std::size_t run = 0; run < by_run.runs.size(); ++run) {
      const std::size_t s = order.index(by_run.sequences[run]);
      if (by_run.values[m][run]) repeats[s].push_back(*by_run.values[m][run]);
      if (!by_run.status[m][run].empty()) status[s] = by_run.status[m][run];
    }
    std::vector<std::optional<double>>& row = out.values.emplace_back(order.names().size());
    for (std::size_t s = 0; s < order.names().size(); ++s) {
      if (!status[s].empty()) continue;
      const bool is_positive = std::ranges::all_of(repeats[s], [](double v) { return v > 0.0; });
      row[s] = is_positive ? geometric_mean(repeats[s]) : mean(repeats[s]);
    }
    out.status.push_back(std::move(status));
  }
  return out;
}

}  // namespace loopbench
