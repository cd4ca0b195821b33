/// Is the difference real? Methods of one sweep, one score at a time.
///
/// Values are paired by run. Against the baseline: geometric mean of the ratios with a bootstrap
/// interval (BCa), wins, losses and ties, Wilcoxon's signed-rank test on the logarithms of the
/// ratios (zeros as Pratt has them), Holm-corrected over the methods, and effect sizes. Among all:
/// average ranks, Friedman's test, Nemenyi's critical difference (Demsar, JMLR 7, 2006), and
/// Wilcoxon tests of the best against each, Holm-corrected over all pairs since the best was picked
/// by looking. Scores are not corrected for each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/observations.hpp"
#include "harness/statistics/bootstrap.hpp"
#include "harness/statistics/differences.hpp"

namespace loopbench {

/// Below this many observations no interval is given: resampling so few says little.
inline constexpr std::size_t kFewestForInterval = 5;

struct CompareOptions {
  std::string baseline;
  std::string value = "rmse";
  Over over = Over::runs;
  double alpha =
      0.05;           ///< level of the tests and of the critical difference; 1 - alpha of intervals
  double tie = kTie;  ///< relative difference that counts as none
  std::size_t resamples = 10000;
  std::uint64_t seed = 1;
};

struct MethodVerdict {
  std::string method;
  double median = 0.0;            ///< of its values
  std::optional<Interval> ratio;  ///< to the baseline; none where a value is not positive
  bool has_interval = false;      ///< ratio.low and ratio.high mean something
  std::size_t wins = 0;           ///< runs better than the baseline
  std::size_t losses = 0;
  std::size_t ties = 0;
  double p = 1.0;              ///< against the baseline, corrected
  double rank_biserial = 0.0;  ///< positive: better than the baseline
  std::optional<double> dz;    ///< Cohen's, positive: better
  double average_rank = 0.0;   ///< 1 is best
  double p_best = 1.0;         ///< against the best ranked, corrected; 1 for itself
  bool equals_best = false;    ///< tied with it on every run
  std::string groups;          ///< letters; sharing one: ranks within the critical difference
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
  bool higher_is_better = false;
  std::size_t observations = 0;        ///< that every ranked method has: all numbers are over these
  std::size_t possible = 0;            ///< that any method has, or should have
  std::size_t sequences = 0;           ///< among the observations
  std::vector<std::string> runs;       ///< the observations by name
  std::size_t longest_block = 0;       ///< intervals are along runs, blocks up to this [poses]
  std::vector<MethodVerdict> methods;  ///< by average rank, best first
  std::vector<Gap> gaps;
  std::vector<std::string> oracles;  ///< methods left out: they were shown the reference
  double friedman_p = 1.0;
  double critical_difference = 0.0;
  double least_p = 1.0;       ///< that one test can reach with so many observations
  double least_p_holm = 1.0;  ///< after the correction over the methods
};

/// One comparison for each score, without those that have no better and worse. Deterministic.
/// Throws InputError when the baseline is no method of the records, when `where` left no score, and
/// for an unknown statistic. Comparisons with no common run, or one method, have no methods.
std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options);

/// One line: which is best, by how much, and which are not different from it.
std::string verdict(const Comparison& comparison);

/// What must be known to read the numbers: what they are over, gaps, tests, limits.
std::vector<std::string> remarks(const Comparison& comparison);

}  // namespace loopbench
