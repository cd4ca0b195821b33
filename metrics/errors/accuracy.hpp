/// Shares of poses with a position error below thresholds.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "metrics/metric.hpp"
#include "metrics/trajectory/tracking_gaps.hpp"

namespace loopbench::metrics {

struct AccuracyOptions {
  std::string thresholds = "0.01 0.03 0.1 0.3 1";
};

template <class Visit>
void fields(AccuracyOptions& o, Visit visit) {
  visit("thresholds", o.thresholds, "thresholds of the position error, ascending [m]");
}

inline constexpr double kAccuracyPause = 2.0;  // [s], as for Coverage::span

/// Time that each pair stands for [s].
inline std::vector<double> represented_time(const Trajectory& reference, const Trajectory& paired) {
  const std::vector<TrackingGap> gaps =
      tracking_gaps(reference, stamps(paired), 0.0, kAccuracyPause);
  std::vector<double> out(paired.size(), 0.0);
  std::size_t gap = 0;
  for (std::size_t i = 1; i < paired.size(); ++i) {
    const double begin = paired[i - 1].stamp;
    while (gap < gaps.size() && gaps[gap].begin < begin) ++gap;
    if (gap < gaps.size() && gaps[gap].begin == begin) continue;
    const double half = 0.5 * std::max(0.0, paired[i].stamp - begin);
    out[i - 1] += half;
    out[i] += half;
  }
  return out;
}

/// Numbers of a text such as "0.1 0.3", positive and ascending. Throws OptionError.
inline std::vector<double> ascending_numbers(const std::string& option, const std::string& text) {
  std::vector<double> out;
  std::istringstream in(text);
  for (double number = 0.0; in >> number;) {
    if (!(number > (out.empty() ? 0.0 : out.back()))) break;
    out.push_back(number);
  }
  if (!in.eof() || out.empty()) {
    throw OptionError(option, option + " = '" + text + "': expected positive ascending numbers");
  }
  return out;
}

/// Throws OptionError for thresholds that are not positive and ascending.
inline void check_combination(const AccuracyOptions& options) {
  ascending_numbers("thresholds", options.thresholds);
}

/// `within` [%]: share of the reference's time with an error below each threshold;
/// a pair stands for half of the time to its neighbours. Tracking gaps (as in Coverage) and the
/// time before the first and after the last pair count as failed. `area` [%]: area under the curve
/// of this share over thresholds from 0 to the largest one, which is the mean of 1 - error /
/// largest, at least 0. Throws Undefined for a reference of one stamp. O(n log n).
inline std::vector<Score> accuracy(const Evaluation& evaluation, const AccuracyOptions& options) {
  const std::vector<double> thresholds = ascending_numbers("thresholds", options.thresholds);
  const Trajectory& reference = needed(evaluation.context.reference, "the complete reference");
  const double duration = reference.back().stamp - reference.front().stamp;
  if (!(duration > 0.0)) throw Undefined("the reference has no duration");
  std::vector<double> errors;
  for (std::size_t i = 0; i < evaluation.reference.size(); ++i) {
    errors.push_back((evaluation.reference[i].world_from_body.translation -
                      evaluation.estimate[i].world_from_body.translation)
                         .norm());
  }
  const std::vector<double> seconds = represented_time(reference, evaluation.reference);
  std::vector<Score> out;
  double area = 0.0;
  for (const double threshold : thresholds) {
    double within = 0.0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (errors[i] < threshold) within += seconds[i];
    }
    out.push_back(
        directed(single("within", fmt::format("{:g}", threshold), "%", 100.0 * within / duration),
                 Better::higher));
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    area += seconds[i] * std::max(0.0, 1.0 - errors[i] / thresholds.back());
  }
  out.push_back(directed(single("area", "", "%", 100.0 * area / duration), Better::higher));
  for (Score& score : out) score.statistics.count = errors.size();
  return out;
}

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
