/// Is the difference real? Methods of one sweep, one score at a time.
///
/// The observation is a group of runs that are not independent of each other (one route, one
/// simulated instance); runs of equal content count once. Within a group, logarithms of the ratios
/// to the other method are averaged; ratios, intervals, tests and ranks are over groups, all from
/// the one procedure in ranking.hpp. A run on which a method fails is lost in the tests, and left
/// out of its ratio. Scores are not corrected for each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/observations.hpp"
#include "harness/compare/ranking.hpp"

namespace loopbench {

/// What one observation is.
enum class Over {
  groups,    ///< runs with one Record::group, or a run by itself
  runs,      ///< every run, taken as independent although groups are known
  sequences  ///< runs of a sequence or of a group together: conclusions reach to other sequences
};

struct CompareOptions {
  std::string baseline;
  std::string value = "rmse";
  Over over = Over::groups;
  double alpha = 0.05;          ///< of all claims of one comparison; 1 - alpha of each interval
  double relevant = kRelevant;  ///< relative difference up to which values are equal
};

struct MethodVerdict {
  std::string method;
  double median = 0.0;            ///< of its values
  std::size_t runs = 0;           ///< with a value
  std::size_t fails = 0;          ///< runs that it loses
  std::string why_fails;          ///< "failed 2, declined 1"
  std::optional<Interval> ratio;  ///< geometric mean of value / baseline over groups
  bool has_interval = false;      ///< ratio.low and ratio.high mean something
  std::string why_no_interval;    ///< of a ratio without one
  std::size_t wins = 0;           ///< groups better than the baseline
  std::size_t losses = 0;
  std::size_t ties = 0;
  std::optional<double> p;     ///< against the baseline; none where nothing can be proven
  double rank_biserial = 0.0;  ///< positive: better than the baseline
  bool beats_baseline = false;
  bool is_leader = false;  ///< first in order, or equal to the first on every group
  bool is_beaten_by_leader = false;
  std::size_t lowest_rank = 1;  ///< that the claims leave: 1 is best
  std::size_t highest_rank = 1;
  std::string letters;  ///< sharing one: neither is proven better
};

/// A method that has no value on any run, or lacks some.
struct Gap {
  std::string method;
  std::size_t missing = 0;  ///< runs without a value
  std::string why;          ///< "failed 2, declined 1"
  bool is_ranked = true;    ///< false: no value at all, so left out of the comparison
};

struct Comparison {
  Record kind;  ///< protocol, times, metric, relation, axis, unit
  CompareOptions options;
  std::size_t groups = 0;              ///< observations
  std::size_t runs = 0;                ///< among them: every ranked method has a value or failed
  std::size_t possible = 0;            ///< runs that any method has, or should have
  std::size_t copies = 0;              ///< runs of the same content as another, not counted
  std::size_t sequences = 0;           ///< among the runs
  std::size_t stated_groups = 0;       ///< of the runs, whatever options.over
  std::vector<MethodVerdict> methods;  ///< best first
  std::vector<Gap> gaps;
  std::vector<std::string> oracles;          ///< methods left out: they were shown the reference
  std::vector<std::string> oracle_closures;  ///< sequences with closures from the reference
  bool is_best_proven = false;               ///< the leaders beat all other methods
  bool is_ratio = true;                      ///< false: plain differences, some value is negative
  std::size_t pairs = 0;                     ///< of methods that differ somewhere
  std::size_t groups_needed = 0;             ///< fewest that can prove anything
};

/// One comparison for each score, without those that have no better and worse. Deterministic.
/// Throws InputError when the baseline is no method of the records, when `where` left no score, and
/// for an unknown statistic. Comparisons with no common run, or one method, have no methods.
std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options);

/// Methods that were shown the reference on a run on which another was not.
std::vector<std::string> oracle_methods(const std::vector<Record>& records);

/// "8 runs", "20 sequences", "6 groups (30 runs)": what the numbers are over.
std::string unit_text(const Comparison& comparison);

/// One line: which is best, by how much, and which are not different from it.
std::string verdict(const Comparison& comparison);

/// What must be known to read the numbers: what they are over, gaps, tests, limits.
std::vector<std::string> remarks(const Comparison& comparison);

}  // namespace loopbench
