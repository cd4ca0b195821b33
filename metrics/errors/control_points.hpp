/// Score of surveyed control points, as of the Hilti SLAM Challenge.
#pragma once

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

/// Throws OptionError for lists of different length or order.
void check_combination(const ControlPointsOptions& options);

/// `score` [%]: sum of the points over the largest possible sum, where pairs that could have been
/// evaluated, but were not, get none (Coverage::possible). `within` [%]: share of these below each
/// threshold. The defaults are those of the Hilti SLAM Challenge 2023 (its README). O(n).
std::vector<Score> control_points(const Evaluation& evaluation,
                                  const ControlPointsOptions& options);

}  // namespace loopbench::metrics
