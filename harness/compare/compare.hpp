/// Statistical comparison of the methods of a sweep, one score at a time.
///
/// The observation is a group of dependent runs (one route, one simulated instance); runs of equal
/// content count once. Two methods are compared on the groups that both were run on, see pair.hpp.
/// No correction for multiple scores.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/compare/observations.hpp"
#include "harness/compare/pair.hpp"
#include "harness/compare/signed_rank.hpp"

namespace loopbench::harness {

/// Unit of observation.
enum class Over {
  groups,    ///< runs with the same CellRow::group, or single runs without a group
  sequences  ///< all runs of a sequence or of a group: generalises to other sequences
};

struct CompareOptions {
  std::string baseline;
  std::string value = "rmse";
  Over over = Over::groups;
  double alpha = 0.05;     ///< probability of a false claim among those about a score
  double tie = kTieShare;  ///< relative difference up to which values are equal
  double relevant = 0.01;  ///< relative difference from which on a method is better for practice
  bool paired = false;     ///< also pair runs of files, by their names; those of sweeps always are
};

/// How a method compares with the leader.
enum class Standing {
  leader,
  equal,   ///< on every run
  near,    ///< significantly worse, but typically by less than a relevant difference
  behind,  ///< significantly worse
  open     ///< not significantly different
};
inline auto choices(Standing) {
  return std::array{std::pair{"leader", Standing::leader},
                    std::pair{"equal", Standing::equal},
                    std::pair{"near", Standing::near},
                    std::pair{"behind", Standing::behind},
                    std::pair{"open", Standing::open}};
}

/// The best of several methods.
///
/// A method is significantly better than another if their pair's p, corrected for the number of
/// other methods, is at most alpha: that covers each method against the baseline, or each against
/// the leader. Equal methods count once. The leader was run on half of the groups or more
/// and is ahead of all others by ranks, if there is such a method, and best if it is significantly
/// better than all of them; methods behind it by less than a relevant difference are best with it.
struct Ranking {
  std::size_t leader = 0;
  std::vector<Standing> standings;  ///< of each method
  std::vector<Pair> from_leader;    ///< the leader against each method
  std::size_t tests = 1;            ///< different methods, but one
  bool can_show = false;            ///< whether p of some pair can be small enough
  /// Fewest groups for which it can be; of independent runs, fewest of each method and sequence.
  std::size_t groups_needed = 1;

  /// Whether the leading methods are significantly better than all others; false if all are equal.
  bool is_best() const;
};

/// Deterministic. O(methods * (runs log runs + groups^3)), groups^3 for up to 50 groups only.
Ranking rank_methods(const Levels& levels, const CompareOptions& options);

/// Mean ratio on one sequence.
struct SequenceRatio {
  std::string sequence;
  double ratio = 1.0;
  bool is_clear = false;  ///< differs from 1 by more than two standard errors
};

/// Ratio of two methods, the first by the second.
struct Ratio {
  Interval typical;           ///< Hodges-Lehmann, with a simultaneous interval
  bool has_interval = false;  ///< false: too few groups; typical.low and high equal the estimate
  std::optional<double> geometric_mean;  ///< over groups on which both have values; none with zeros
  std::vector<SequenceRatio> by_sequence;  ///< if each sequence has several groups
};

struct MethodVerdict {
  std::string method;
  double median = 0.0;         ///< of its values
  std::size_t runs = 0;        ///< runs with a value
  std::size_t fails = 0;       ///< runs that count as a loss
  std::string why_fails;       ///< "crashed 1, failed 2"
  std::size_t declines = 0;    ///< of all possible runs
  double coverage = 1.0;       ///< of the reference, mean over its values, 0..1
  std::optional<Ratio> ratio;  ///< to the baseline; none for values below zero, most runs failed
  std::size_t wins = 0;        ///< groups better than the baseline
  std::size_t losses = 0;
  std::size_t ties = 0;
  std::optional<double> p;       ///< against the baseline, corrected; none if no test is possible
  bool beats_baseline = false;   ///< significantly better
  bool is_beaten = false;        ///< significantly worse than the baseline
  bool is_contradicted = false;  ///< p is at most alpha, but the geometric mean disagrees
  Standing standing = Standing::open;  ///< relative to the leader
  std::optional<Ratio> from_leader;    ///< the leader's ratio to this method
};

/// A method that lacks values on some or all runs.
struct Gap {
  std::string method;
  std::size_t missing = 0;  ///< runs without a value
  std::string why;          ///< "failed 2, declined 1"
  bool is_ranked = true;    ///< false: no value at all, excluded from the comparison
};

struct Comparison {
  ScoreKind kind;  ///< with unit and direction of the statistic
  CompareOptions options;
  std::size_t groups = 0;              ///< observations
  std::size_t runs = 0;                ///< runs used: two ranked methods have a value or failed
  std::size_t possible = 0;            ///< runs that any method has, or should have
  std::size_t copies = 0;              ///< runs with the same content as another, not counted
  std::size_t sequences = 0;           ///< sequences of the runs used
  std::size_t possible_sequences = 0;  ///< sequences of the possible runs
  /// Sequences with an earlier one's recording: "c2 of c1".
  std::vector<std::string> same_recordings;
  std::vector<std::string> unstable;   ///< methods with different values on equal data
  std::vector<MethodVerdict> methods;  ///< the leader first, others by their ratio to the baseline
  std::vector<Gap> gaps;
  std::vector<std::string> oracles;          ///< excluded methods that use the reference
  std::vector<std::string> oracle_closures;  ///< sequences with closures from the reference
  bool is_best = false;           ///< the leading methods are significantly better than all others
  bool is_ratio = true;           ///< false: plain differences, some value is negative
  bool is_paired = true;          ///< false: independent runs of the same sequences
  bool has_strata = false;        ///< compared by rank sums within sequences
  std::size_t tests = 0;          ///< for whose number p is corrected
  bool can_show = false;          ///< whether the observations can be significant at all
  std::size_t groups_needed = 0;  ///< minimum for that; if has_strata, per method and sequence
};

/// Whether the method leads: it is first, or as good as the first.
bool is_leading(const MethodVerdict& method);

/// One comparison for each score that has a direction. Deterministic. Throws InputError if the
/// baseline is not a method of the records, if `where` leaves no score, and for an unknown
/// statistic. Comparisons without a common run, or with one method, have no methods.
std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options);

/// The same for observations of `options.value`.
std::vector<Comparison> compare(std::vector<Observations> all, const CompareOptions& options);

/// Which methods are best, as in compare(), but without a baseline: no ratios to it, wins and p;
/// the methods are in the order of the observations.
Comparison standings(Observations all, const CompareOptions& options);

/// Methods that cover clearly less of the reference than another one, and those of them that lead.
std::vector<std::string> methods_with_less_coverage(const Comparison& comparison);
std::vector<std::string> leaders_with_less_coverage(const Comparison& comparison);

/// "half covers 53 % of the reference, others up to 100 %"; empty for no methods.
std::string coverage_text(const Comparison& comparison, const std::vector<std::string>& methods);

/// "8 runs", "20 sequences", "6 groups (30 runs)": the observations of a comparison.
std::string unit_text(const Comparison& comparison);

/// One-line verdict: the best method, its gain, and the methods that do not differ significantly.
std::string verdict(const Comparison& comparison);

/// "translation ate, rmse [m], dense, loopbench: " and the verdict.
std::string statement(const Comparison& comparison);

/// Properties of the data that limit the claims: observations, copies, gaps and oracles.
std::vector<std::string> conditions(const Comparison& comparison);

/// The conditions, the tests and their limitations.
std::vector<std::string> remarks(const Comparison& comparison);

}  // namespace loopbench::harness
