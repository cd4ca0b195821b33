#include "harness/export/derived.hpp"

#include <map>
#include <set>
#include <tuple>

namespace loopbench {
namespace {

auto place(const Record& r) {
  return std::tie(r.sequence, r.repeat, r.protocol, r.times, r.metric, r.axis);
}
using Place =
    std::tuple<std::string, std::int64_t, std::string, std::string, std::string, std::string>;

bool is_gain_source(const Record& r) {
  return r.metric == "ate" && r.relation == "translation" && r.status == "ok";
}

double gain(double value, double baseline) {
  return baseline == 0.0 ? 0.0 : 100.0 * (1.0 - value / baseline);
}

}  // namespace

std::vector<Record> gains(const std::vector<Record>& records, const std::string& baseline) {
  std::map<Place, const Statistics*> base;
  for (const Record& r : records) {
    if (is_gain_source(r) && r.method == baseline) base.emplace(place(r), &r.statistics);
  }
  std::vector<Record> out;
  for (const Record& r : records) {
    const auto found = is_gain_source(r) ? base.find(place(r)) : base.end();
    if (found == base.end()) continue;
    const Statistics& b = *found->second;
    Record g = r;
    g.metric = "gain";
    g.unit = "%";
    for (double Statistics::*number : {&Statistics::rmse,
                                       &Statistics::mean,
                                       &Statistics::median,
                                       &Statistics::std,
                                       &Statistics::min,
                                       &Statistics::max,
                                       &Statistics::sse}) {
      g.statistics.*number = gain(r.statistics.*number, b.*number);
    }
    out.push_back(std::move(g));
  }
  return out;
}

std::vector<Record> run_times(const std::vector<Record>& records) {
  std::vector<Record> out;
  std::set<std::tuple<std::int64_t, std::string, std::string>> seen;
  for (const Record& r : records) {
    if (r.status != "ok" || !seen.emplace(r.cell, r.protocol, r.times).second) continue;
    Record t = r;
    t.metric = "time";
    t.relation = t.axis = "";
    t.unit = "ms";
    const double ms = r.milliseconds;
    t.statistics = {1, ms, ms, ms, 0.0, ms, ms, ms * ms};
    out.push_back(std::move(t));
  }
  return out;
}

}  // namespace loopbench
