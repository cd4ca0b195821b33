/// Test for small losses that are consistent over runs.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

#include "harness/gate/check.hpp"
#include "harness/gate/sign_flips.hpp"

namespace loopbench::harness {

/// Collects old and new numbers of every method on every run, and tests whether a method became
/// worse. Runs of one group are one observation (their mean), and runs of equal content count once.
/// All methods, scores and statistics are tested jointly as one family (see sign_flips.hpp), so the
/// smallest p is 2^-runs for any number of scores. Scores without a direction are not tested.
class ConsistentLosses {
 public:
  /// `cell` is the current run; `score` and `statistic` of `limit.values` name the number.
  void add(const GateCell& cell,
           const GateScore& score,
           const std::string& statistic,
           const Tolerance& limit,
           double before,
           double now);

  /// One regression per method that became worse, for its most significant score.
  std::vector<Finding> findings() const;

  /// Methods with too few independent runs for any test to reach its level.
  std::vector<std::string> notes() const;

 private:
  struct ScoreKey {
    std::string method;
    std::string score;
    std::string statistic;
    auto operator<=>(const ScoreKey&) const = default;
  };
  struct Series {
    std::vector<std::size_t> groups;    // per run
    std::vector<std::string> contents;  // per run; can be empty
    std::vector<double> before;
    std::vector<double> now;
    metrics::Better better = metrics::Better::lower;
    Tolerance limit;
  };
  /// Changes of one score of one method.
  struct Moves {
    RunDifferences by_group;  // positive: worse
    bool is_ratio = false;    // logarithms of ratios
  };
  static Moves moves(const Series& series);
  std::string text(const ScoreKey& key, const Series& series, double p, std::size_t others) const;

  std::map<ScoreKey, Series> series_;
  std::map<std::string, std::size_t> groups_;
};

}  // namespace loopbench::harness
