/// Score of surveyed control points, as of the Hilti SLAM Challenge.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "metrics/errors/accuracy.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct ControlPointsOptions {
  std::string thresholds = "0.005 0.01 0.03 0.06 0.1 0.4";
  std::string points = "20 10 6 5 3 1";
};

template <class Visit>
void fields(ControlPointsOptions& o, Visit visit) {
  visit("thresholds", o.thresholds, "thresholds of the position error, ascending [m]");
  visit("points", o.points, "points for an error below each threshold, descending [-]");
}

inline std::vector<double> descending_points(const ControlPointsOptions& options) {
  std::vector<double> out;
  std::istringstream in(options.points);
  for (double number = 0.0; in >> number;) out.push_back(number);
  const bool is_descending = std::ranges::is_sorted(out, std::greater<>());
  const std::size_t wanted = ascending_numbers("thresholds", options.thresholds).size();
  if (in.eof() && is_descending && out.size() == wanted && out.back() > 0.0) return out;
  throw OptionError("points",
                    "points = '" + options.points + "': expected " + std::to_string(wanted) +
                        " positive descending numbers, one for each threshold");
}

/// Throws OptionError for lists of different length or order.
inline void check_combination(const ControlPointsOptions& options) { descending_points(options); }

/// `score` [%]: sum of the points over the largest possible sum, where pairs that could have been
/// evaluated, but were not, get none (Coverage::possible). `within` [%]: share of these below each
/// threshold. The defaults are those of the Hilti SLAM Challenge 2023 (its README). O(n).
inline std::vector<Score> control_points(const Evaluation& evaluation,
                                         const ControlPointsOptions& options) {
  const std::vector<double> thresholds = ascending_numbers("thresholds", options.thresholds);
  const std::vector<double> points = descending_points(options);
  const auto possible = static_cast<double>(evaluation.coverage.possible);
  double sum = 0.0;
  std::vector<double> within(thresholds.size(), 0.0);
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    const double error = (evaluation.reference[i].world_from_body.translation -
                          evaluation.estimate[i].world_from_body.translation)
                             .norm();
    const auto above = std::ranges::upper_bound(thresholds, error);
    const auto first = static_cast<std::size_t>(above - thresholds.begin());
    if (first < points.size()) sum += points[first];
    for (std::size_t k = first; k < within.size(); ++k) within[k] += 1.0;
  }
  const auto percent = [&](const char* relation, const std::string& axis, double share) {
    Score out = directed(single(relation, axis, "%", 100.0 * share), Better::higher);
    out.statistics.count = evaluation.reference.size();
    return out;
  };
  std::vector<Score> out{percent("score", "", sum / (points.front() * possible))};
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    out.push_back(percent("within", fmt::format("{:g}", thresholds[k]), within[k] / possible));
  }
  return out;
}

}  // namespace loopbench::metrics
