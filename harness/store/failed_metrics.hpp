/// Records for the scores of metrics that failed or were declined completely.
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// A metric that throws has no scores, hence one record without relation. It is replaced by a
/// record for every score that the metric has on the same run or, if it has none there, anywhere.
class FailedMetrics {
 public:
  using MetricKey = std::tuple<std::string, std::string, std::string, std::string>;
  using Scores = std::vector<Record>;  ///< of a metric, in order of first appearance

  /// Adds a score that a metric has somewhere in the store.
  void add(const Record& record);

  /// Expands the records of complete runs. O(n log n).
  void expand(std::vector<Record>& records) const;

 private:
  std::map<MetricKey, Scores> anywhere_;
};

}  // namespace loopbench::harness
