#include "harness/compare/observations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "harness/compare/name_order.hpp"

namespace loopbench::harness {
namespace {

auto table_kind(const Record& r) {
  return std::tie(r.protocol, r.times, r.metric, r.label, r.relation, r.axis);
}
using TableKind =
    std::tuple<std::string, std::string, std::string, std::string, std::string, std::string>;

Observed observed(const Record& r, const std::string& value_name) {
  if (!r.metric.empty() && r.status == "ok") {
    const double number = value(r, value_name);
    if (std::isfinite(number)) return {number, false, ""};
    return {std::nullopt, true, "not finite"};
  }
  return {std::nullopt, is_loss(r), r.status == "ok" ? "not evaluated" : r.status};
}

}  // namespace

std::string run_name(const Record& r) {
  return r.repeat == 0 ? r.sequence : r.sequence + " (repeat " + std::to_string(r.repeat) + ")";
}

std::string group_name(const Record& r) { return r.group.empty() ? run_name(r) : r.group; }

bool is_loss(const Record& r) {
  if (r.status == "ok") return false;
  return r.metric.empty() || (r.status != "undefined" && r.status != "declined");
}

std::vector<Observations> observations(const std::vector<Record>& records,
                                       const std::string& value_name) {
  NameOrder methods;
  NameOrder runs;
  std::vector<ObservedRun> found_runs;
  std::map<TableKind, std::size_t> tables;
  std::vector<Observations> out;
  for (const Record& r : records) {
    methods.index(r.method);
    if (runs.index(run_name(r)) == found_runs.size()) {
      found_runs.push_back({run_name(r), r.sequence, group_name(r), r.content, r.oracle_closures});
    }
    if (r.metric.empty() || !tables.emplace(table_kind(r), out.size()).second) continue;
    out.emplace_back().kind = r;
  }
  for (Observations& table : out) {
    table.methods = methods.names();
    table.runs = found_runs;
    table.values.assign(table.methods.size(), std::vector<Observed>(found_runs.size()));
  }
  const auto put = [&](Observations& table, const Record& r) {
    table.values[methods.index(r.method)][runs.index(run_name(r))] = observed(r, value_name);
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

std::size_t drop_duplicates(Observations& all) {
  std::map<std::string, std::size_t> first;  // first run of each content
  std::vector<std::size_t> kept;
  for (std::size_t run = 0; run < all.runs.size(); ++run) {
    const std::string& content = all.runs[run].content;
    const auto [found, is_new] = first.emplace(content, run);
    if (content.empty() || is_new) {
      kept.push_back(run);
      continue;
    }
    for (std::vector<Observed>& of_method : all.values) {
      Observed& one = of_method[found->second];
      const Observed& copy = of_method[run];
      if (copy.is_loss || (!one.value && !one.is_loss)) one = copy;
    }
  }
  const std::size_t dropped = all.runs.size() - kept.size();
  std::vector<ObservedRun> runs;
  for (const std::size_t run : kept) runs.push_back(all.runs[run]);
  all.runs = std::move(runs);
  for (std::vector<Observed>& of_method : all.values) {
    std::vector<Observed> values;
    for (const std::size_t run : kept) values.push_back(of_method[run]);
    of_method = std::move(values);
  }
  return dropped;
}

}  // namespace loopbench::harness
