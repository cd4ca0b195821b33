/// Share of time with a position error below thresholds.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct AccuracyOptions {
  std::string thresholds = "0.01 0.03 0.1 0.3 1";
};

template <class Visit>
void fields(AccuracyOptions& o, Visit visit) {
  visit("thresholds", o.thresholds, "thresholds of the position error, ascending [m]");
}

/// Throws OptionError for thresholds that are not positive and ascending.
void check_combination(const AccuracyOptions& options);

/// Numbers of a text such as "0.1 0.3", positive and ascending. Throws OptionError.
std::vector<double> ascending_numbers(const std::string& option, const std::string& text);

/// `within` [%]: share of the reference's time with an error below each threshold;
/// a pair stands for half of the time to its neighbours. Tracking gaps (as in Coverage) and the
/// time before the first and after the last pair count as failed. `area` [%]: area under the curve
/// of this share over thresholds from 0 to the largest one, which is the mean of 1 - error /
/// largest, at least 0. Throws Undefined for a reference of one stamp. O(n log n).
std::vector<Score> accuracy(const Evaluation& evaluation, const AccuracyOptions& options);

}  // namespace loopbench::metrics
