#include "harness/tables/usual_table.hpp"

#include <algorithm>

#include "harness/tables/pivot.hpp"

namespace loopbench::harness {
namespace {

/// Keeps one kind of times; returns its name if there were several.
std::string keep_one_time(std::vector<Record>& records) {
  std::vector<std::string> times;
  for (const Record& r : records) {
    if (!r.metric.empty() && std::ranges::count(times, r.times.text()) == 0)
      times.push_back(r.times);
  }
  if (times.size() < 2) return "";
  const std::string kept = std::ranges::count(times, "dense") > 0 ? "dense" : times.front();
  std::erase_if(records, [&](const Record& r) { return !r.metric.empty() && r.times != kept; });
  return kept;
}

/// Keeps the first score that is shown; returns its name.
std::string keep_one_score(std::vector<Record>& records, const std::vector<std::string>& show) {
  const auto is_shown = [&](const Record& r) {
    return !r.metric.empty() && (show.empty() || std::ranges::count(show, field(r, "score")) > 0);
  };
  const auto first = std::ranges::find_if(records, is_shown);
  if (first == records.end()) return "";
  const Record kept = *first;
  std::erase_if(records, [&](const Record& r) {
    return !r.metric.empty() && (metric_label(r) != metric_label(kept) ||
                                 r.relation != kept.relation || r.axis != kept.axis);
  });
  return field(kept, "score");
}

}  // namespace

std::string make_usual(std::vector<Record>& records, TableSpec& spec) {
  for (auto* names : {&spec.rows, &spec.columns, &spec.split}) std::erase(*names, "");
  std::string score;
  if (!separates(spec, {"method"})) {
    spec.columns = {"method"};
    std::erase(spec.split, "sequence");
    std::erase(spec.split, "times");
    if (!separates(spec, {"score", "metric", "label"})) score = keep_one_score(records, spec.show);
  }
  const std::string times = separates(spec, {"times"}) ? "" : keep_one_time(records);
  std::string out;
  if (!score.empty()) out = "score: " + score + " (others: --show)";
  if (!times.empty())
    out += (out.empty() ? "" : "; ") + ("times: " + times) + " (others: --where times=...)";
  return out;
}

}  // namespace loopbench::harness
