#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "datasets/core/error.hpp"
#include "harness/compare/levels.hpp"
#include "harness/profile/grouping.hpp"
#include "harness/profile/profile.hpp"
#include "harness/statistics/average.hpp"
#include "harness/statistics/ranks.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::harness {
namespace {

/// Geometric mean of non-negative values; none if one of them is zero within rounding, because a
/// single one would decide the mean.
std::optional<double> geometric_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    if (value <= zero_floor(0.0)) return std::nullopt;
    sum += std::log(value);
  }
  return std::exp(sum / static_cast<double>(values.size()));
}

struct Chosen {
  std::string protocol;
  std::string times;
  std::string label;
};

bool is_score(const Record& r, const Accuracy& accuracy) {
  const bool is_metric = r.metric == accuracy.metric || metric_label(r) == accuracy.metric;
  return r.status == Status::ok && is_metric && r.relation == accuracy.relation &&
         r.axis == accuracy.axis;
}

/// The first protocol, dense if available; a metric by its label before its name.
Chosen choose(const RecordSource& records, const Accuracy& accuracy) {
  Chosen out;
  records([&](const Record& r) {
    if (!is_score(r, accuracy)) return;
    if (out.protocol.empty()) out = {r.protocol, r.times, metric_label(r)};
    if (metric_label(r) == accuracy.metric) out.label = accuracy.metric;
    if (r.protocol == out.protocol && r.times == "dense") out.times = r.times;
  });
  return out;
}

struct Point {
  std::string method;
  bool is_oracle = false;
  std::size_t runs = 0;         // runs with an error
  std::optional<double> error;  // none if an error is zero
  double seconds = 0.0;
};

/// One point per method that has errors, the fastest first. `error_of`: by position of the cell.
std::vector<Point> points_of(const std::vector<CellRecord>& cells,
                             const std::map<std::int64_t, double>& error_of) {
  std::vector<Point> points;
  for (const auto& [method, all] : by_method(cells)) {
    std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> by_sequence;
    std::size_t runs = 0;
    for (const CellRecord* cell : all) {
      const auto error = error_of.find(cell->position);
      if (error == error_of.end() || cell->runs == 0) continue;
      ++runs;
      by_sequence[cell->sequence].first.push_back(error->second);
      by_sequence[cell->sequence].second.push_back(cell->seconds);
    }
    if (by_sequence.empty()) continue;
    std::vector<double> errors;
    std::vector<double> times;
    for (const auto& [sequence, values] : by_sequence) {
      errors.push_back(mean(values.first));
      times.push_back(metrics::median(values.second));
    }
    points.push_back({method,
                      is_oracle(all),
                      runs,
                      geometric_mean(errors),
                      geometric_mean(times).value_or(0.0)});
  }
  std::ranges::stable_sort(points, {}, &Point::seconds);
  return points;
}

/// yes, no, or a dash for methods that are excluded.
std::vector<std::string> on_front(const std::vector<Point>& points, std::size_t runs) {
  const auto competes = [&](const Point& p) {
    return p.runs == runs && !p.is_oracle && p.error.has_value();
  };
  std::vector<double> errors;
  std::vector<double> times;
  for (const Point& point : points) {
    if (!competes(point)) continue;
    errors.push_back(*point.error);
    times.push_back(point.seconds);
  }
  const std::vector<bool> front = pareto_front(errors, times);
  std::vector<std::string> out;
  std::size_t next = 0;
  for (const Point& point : points) {
    out.push_back(!competes(point) ? "-" : front[next] ? "yes" : "no");
    if (competes(point)) ++next;
  }
  return out;
}

}  // namespace

TableView pareto(const std::vector<CellRecord>& cells,
                 const std::vector<Record>& records,
                 const Accuracy& accuracy) {
  const RecordSource source = [&](const auto& visit) { std::ranges::for_each(records, visit); };
  return pareto(cells, source, accuracy);
}

TableView pareto(const std::vector<CellRecord>& cells,
                 const RecordSource& records,
                 const Accuracy& accuracy) {
  if (!has_direction(accuracy.value)) {
    throw InputError("--value: '" + accuracy.value +
                     "' is no accuracy; expected rmse, mean, median, std, min or max");
  }
  const Chosen chosen = choose(records, accuracy);
  std::map<std::int64_t, double> error_of;  // by position
  std::string unit;
  records([&](const Record& r) {
    if (!is_score(r, accuracy) || r.protocol != chosen.protocol || r.times != chosen.times ||
        metric_label(r) != chosen.label) {
      return;
    }
    error_of[r.cell] = value(r, accuracy.value);
    unit = r.unit;
  });
  std::set<std::pair<std::string, std::int64_t>> all_runs;
  for (const CellRecord& cell : cells) all_runs.emplace(cell.sequence, cell.repeat);
  const std::vector<Point> points = points_of(cells, error_of);
  const std::vector<std::string> front = on_front(points, all_runs.size());
  TableView out{"accuracy and time",
                {"method",
                 "runs",
                 accuracy.metric + " " + accuracy.value + " [" + unit + "]",
                 "wall [ms]",
                 "front"},
                {},
                {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    out.lines.push_back({point.method + (point.is_oracle ? " (oracle)" : ""),
                         fmt::format("{} of {}", point.runs, all_runs.size()),
                         point.error ? fmt::format("{:.4g}", *point.error) : "-",
                         fmt::format("{:.4g}", 1e3 * point.seconds),
                         front[i]});
  }
  if (points.empty() && !error_of.empty()) {
    out.notes.push_back(kNoTimes);
    return out;
  }
  if (points.empty()) {
    out.notes.push_back("no cell has " + accuracy.metric + " " + accuracy.relation + " " +
                        accuracy.axis);
    return out;
  }
  out.notes.push_back(fmt::format(
      "geometric means over sequences of the mean over repeats; protocol {}, {}; front: no method "
      "is both faster and more accurate (relative differences below {} are ignored); -: excluded, "
      "because it lacks runs, uses the reference or has no mean error",
      chosen.protocol,
      chosen.times,
      kRelevant));
  std::string perfect;
  for (const Point& point : points) {
    if (!point.error) perfect += (perfect.empty() ? "" : ", ") + point.method;
  }
  if (!perfect.empty()) out.notes.push_back("no mean where an error is zero: " + perfect);
  std::ranges::move(oracle_notes(cells), std::back_inserter(out.notes));
  return out;
}

}  // namespace loopbench::harness
