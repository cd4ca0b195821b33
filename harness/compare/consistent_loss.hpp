/// Test for small losses that are consistent over runs.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "harness/compare/gate.hpp"

namespace loopbench::harness {

/// Collects the changes of every number of every method on every run, and tests whether a method
/// became worse. Runs of one group are one observation (their mean), and runs of equal content
/// count once. All methods, scores and statistics are one family: p is the probability that the
/// largest standardised signed-rank sum of all is at least the observed one if the signs of all
/// changes of a group are flipped together (Westfall and Young, 1993), so that the smallest p is
/// 2^-groups for any number of scores. Scores without a direction are not tested.
class ConsistentLosses {
 public:
  /// `worse`: how much worse the number is now, positive: worse. `score` and `statistic` of
  /// `limit.values` name it; `before` is its earlier value, or distance to the target.
  void add(const GateCell& cell,
           const GateScore& score,
           const std::string& statistic,
           const Tolerance& limit,
           double before,
           double worse);

  /// Adds one regression per method that became worse, for its most significant score, and notes on
  /// methods with too few independent runs for any test to reach its level.
  void report(GateReport& out) const;

 private:
  using Key = std::tuple<std::string, std::string, std::string>;  // method, score, statistic
  struct Series {
    std::set<std::string> contents;                      // of the runs
    std::map<std::size_t, std::vector<double>> changes;  // by group, relative, positive: worse
    std::size_t runs = 0;
    double alpha = 0.0;
  };
  std::vector<double> p_values() const;

  std::map<Key, Series> series_;
  std::map<std::string, std::size_t> groups_;  // numbered
};

}  // namespace loopbench::harness
