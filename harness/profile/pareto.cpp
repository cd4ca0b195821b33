#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "harness/profile/grouping.hpp"
#include "harness/profile/profile.hpp"

namespace loopbench {
namespace {

/// Of values not below zero.
double geometric_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

struct Chosen {
  std::string protocol;
  std::string times;
  std::string label;
};

bool is_score(const Record& r, const Accuracy& accuracy) {
  const bool is_metric = r.metric == accuracy.metric || metric_label(r) == accuracy.metric;
  return r.status == "ok" && is_metric && r.relation == accuracy.relation &&
         r.axis == accuracy.axis;
}

/// The first protocol, dense where there is dense; a metric by its label rather than by its name.
Chosen choose(const std::vector<Record>& records, const Accuracy& accuracy) {
  Chosen out;
  for (const Record& r : records) {
    if (!is_score(r, accuracy)) continue;
    if (out.protocol.empty()) out = {r.protocol, r.times, metric_label(r)};
    if (metric_label(r) == accuracy.metric) out.label = accuracy.metric;
    if (r.protocol == out.protocol && r.times == "dense") out.times = r.times;
  }
  return out;
}

}  // namespace

Listing pareto(const std::vector<CellRecord>& cells,
               const std::vector<Record>& records,
               const Accuracy& accuracy) {
  const Chosen chosen = choose(records, accuracy);
  std::map<std::int64_t, double> error_of;  // by position
  std::string unit;
  for (const Record& r : records) {
    if (!is_score(r, accuracy) || r.protocol != chosen.protocol || r.times != chosen.times ||
        metric_label(r) != chosen.label) {
      continue;
    }
    error_of[r.cell] = value(r, accuracy.value);
    unit = r.unit;
  }
  struct Point {
    std::string method;
    std::size_t sequences = 0;
    double error = 0.0;
    double seconds = 0.0;
  };
  std::vector<Point> points;
  std::set<std::string> all_sequences;
  for (const CellRecord& cell : cells) all_sequences.insert(cell.sequence);
  for (const auto& [method, all] : by_method(cells)) {
    std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> by_sequence;
    for (const CellRecord* cell : all) {
      const auto error = error_of.find(cell->position);
      if (error == error_of.end()) continue;
      by_sequence[cell->sequence].first.push_back(error->second);
      by_sequence[cell->sequence].second.push_back(cell->seconds);
    }
    if (by_sequence.empty()) continue;
    std::vector<double> errors;
    std::vector<double> times;
    for (const auto& [sequence, values] : by_sequence) {
      errors.push_back(mean(values.first));
      times.push_back(median_of(values.second));
    }
    points.push_back({method, by_sequence.size(), geometric_mean(errors), geometric_mean(times)});
  }
  std::ranges::stable_sort(points, {}, &Point::seconds);

  std::vector<double> errors;
  std::vector<double> times;
  for (const Point& point : points) {
    if (point.sequences != all_sequences.size()) continue;
    errors.push_back(point.error);
    times.push_back(point.seconds);
  }
  const std::vector<bool> front = pareto_front(errors, times);
  Listing out{"accuracy and time",
              {"method",
               "sequences",
               accuracy.metric + " " + accuracy.value + " [" + unit + "]",
               "wall [ms]",
               "front"},
              {},
              {}};
  std::size_t next = 0;
  for (const Point& point : points) {
    const bool covers = point.sequences == all_sequences.size();
    out.rows.push_back({point.method,
                        fmt::format("{} of {}", point.sequences, all_sequences.size()),
                        fmt::format("{:.4g}", point.error),
                        fmt::format("{:.4g}", 1e3 * point.seconds),
                        !covers       ? "-"
                        : front[next] ? "yes"
                                      : "no"});
    if (covers) ++next;
  }
  if (points.empty()) {
    out.notes.push_back("no cell has " + accuracy.metric + " " + accuracy.relation + " " +
                        accuracy.axis);
    return out;
  }
  out.notes.push_back("geometric means over sequences of the mean over repeats; protocol " +
                      chosen.protocol + ", " + chosen.times +
                      "; front: no method is both faster and more accurate");
  return out;
}

}  // namespace loopbench
