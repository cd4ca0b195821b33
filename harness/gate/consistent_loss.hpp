/// Small losses that all point the same way.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

#include "harness/gate/check.hpp"
#include "harness/gate/sign_flips.hpp"

namespace loopbench {

/// Collects the numbers of every method on every run before and now, and tests whether a method got
/// worse. Runs of one group are one observation (their mean), and runs of equal content count once.
/// All methods, scores and statistics are one family, tested jointly (see sign_flips.hpp), so that
/// the smallest p is 2^-runs however many scores there are. Scores that have no direction are not
/// tested.
class ConsistentLosses {
 public:
  /// `cell` is the run now; `score` and `limit.values`' `statistic` name the number.
  void add(const GateCell& cell,
           const GateScore& score,
           const std::string& statistic,
           const Tolerance& limit,
           double before,
           double now);

  /// A regression per method that got worse, with the score in which that is clearest.
  std::vector<Finding> findings() const;

  /// Methods that have too few independent runs for any test to reach its level.
  std::vector<std::string> notes() const;

 private:
  struct Place {
    std::string method;
    std::string score;
    std::string statistic;
    auto operator<=>(const Place&) const = default;
  };
  struct Series {
    std::vector<std::size_t> groups;    // of each run
    std::vector<std::string> contents;  // of each run; may be empty
    std::vector<double> before;
    std::vector<double> now;
    Better better = Better::lower;
    Tolerance limit;
  };
  /// One method's moves of one score.
  struct Moves {
    RunDifferences by_group;  // positive: worse
    bool is_ratio = false;    // logarithms of ratios
  };
  static Moves moves(const Series& series);
  std::string text(const Place& place, const Series& series, double p, std::size_t others) const;

  std::map<Place, Series> series_;
  std::map<std::string, std::size_t> groups_;
};

}  // namespace loopbench
