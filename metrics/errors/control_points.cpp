#include "metrics/errors/control_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "metrics/errors/accuracy.hpp"

namespace loopbench::metrics {
namespace {

std::vector<double> descending_points(const ControlPointsOptions& options) {
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

}  // namespace

void check_combination(const ControlPointsOptions& options) { descending_points(options); }

std::vector<Score> control_points(const Evaluation& evaluation,
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
