/// Statistical comparison of the methods of a sweep, one score at a time.
///
/// The observation is a group of dependent runs (one route, one simulated instance); runs of equal
/// content count once. Two methods are compared on the groups that both were run on, see pair.hpp.
/// No correction for multiple scores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/answers/compare/observations.hpp"
#include "harness/answers/compare/pair.hpp"
#include "harness/answers/compare/typical.hpp"

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
  double relevant = 0.02;  ///< relative difference from which on a method is better for practice
  bool paired = false;     ///< also pair runs of files, by their names; those of sweeps always are
};

/// Typical ratio on one sequence.
struct SequenceRatio {
  std::string sequence;
  double ratio = 1.0;
  double p = 1.0;         ///< of the test within the sequence, not corrected
  bool is_clear = false;  ///< significant with Holm's correction over methods and sequences
};

/// Ratio of two methods, the first by the second.
struct Ratio {
  /// Of the mean over the sequences of typical log ratios, see RandomizationTest, with the interval
  /// of level 1 - MethodVerdict::level.
  Interval typical;
  bool has_interval = false;  ///< false: too few groups; typical.low and high equal the estimate
  std::optional<double> geometric_mean;  ///< over groups on which both have values; none with zeros
  std::vector<SequenceRatio> by_sequence;  ///< if each sequence has several groups
  bool is_of_sequences = false;            ///< the typical ratio is a mean over several sequences
};

struct MethodVerdict {
  std::string method;
  MethodParts parts = {};
  bool is_stated = false;      ///< some value is a time that it states itself
  double median = 0.0;         ///< of its values
  std::size_t runs = 0;        ///< runs with a value
  std::size_t fails = 0;       ///< runs on which it failed
  double coverage = 1.0;       ///< of the reference, mean over its values, 0..1
  bool covers_less = false;    ///< clearly less than another method: it is better than none
  std::optional<Ratio> ratio;  ///< to the baseline; none for values below zero, or without a run
                               ///< that both solved
  std::size_t common = 0;      ///< runs that it and the baseline solved
  std::size_t wins = 0;        ///< groups of these on which it is better than the baseline
  std::size_t losses = 0;
  std::size_t ties = 0;
  double level = 0.05;          ///< of its comparison with the baseline, so that all hold together
  std::optional<double> p;      ///< against the baseline, corrected; none if no test is possible
  bool beats_baseline = false;  ///< p is at most alpha, and it is not shown to fail more often
  bool is_beaten = false;       ///< the same of the baseline
  bool is_worse = false;        ///< than some method; otherwise it shares the first place
  bool fails_more = false;      ///< it is shown to fail more often than the baseline
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
  std::size_t groups = 0;     ///< observations
  std::size_t runs = 0;       ///< runs used: two ranked methods have a value or failed
  std::size_t possible = 0;   ///< runs that any method has, or should have
  std::size_t copies = 0;     ///< runs with the same content as another, not counted
  std::size_t sequences = 0;  ///< sequences of the runs used
  /// Sequences with an earlier one's recording: "c2 of c1".
  std::vector<std::string> same_recordings;
  std::vector<std::string> unstable;   ///< methods with different values on equal data
  std::vector<MethodVerdict> methods;  ///< the first place first, then by ratio to the baseline
  std::vector<Gap> gaps;
  std::vector<std::string> oracles;          ///< excluded methods that use the reference
  std::vector<std::string> oracle_closures;  ///< sequences with closures from the reference
  bool is_ratio = true;                      ///< false: plain differences, some value is negative
  bool is_paired = true;                     ///< false: independent runs of the same sequences
  bool is_best = false;           ///< the first methods are best: all others are worse than one
  std::size_t tests = 0;          ///< different methods, but one, for which p is corrected
  bool can_show = false;          ///< whether the observations can be significant at all
  std::size_t common = 0;         ///< most observations that two methods solved
  bool is_independent = false;    ///< two samples of each sequence are compared
  std::size_t groups_needed = 0;  ///< minimum to show anything; if independent, of each sample

  /// The verdict about a method; null for one that is not compared.
  const MethodVerdict* find(const std::string& method) const {
    const auto found = std::ranges::find(methods, method, &MethodVerdict::method);
    return found == methods.end() ? nullptr : &*found;
  }
};

/// Sets the levels, and which methods are worse than another one, the others sharing the first
/// place; and the last six members above.
///
/// A method is best if it is ahead of each rival with p <= alpha, which is one hypothesis about all
/// rivals, and also of the baseline with p <= 0.8 alpha; the baseline is best if each comparison
/// with it is shown. Otherwise each comparison with the baseline has the level of Sidak's
/// correction, and the share of alpha of those that are shown (at least a tenth) is that of Holm's
/// correction over all other pairs (Bretz et al., 2009). A method that is behind by less than a
/// relevant difference shares the place of the other. One with less coverage than another is better
/// than none, and one that fails on runs that another solves is not better than that, unless the
/// other is shown to fail more often. Equal methods count once. Without a baseline, a method is
/// best if it would be with every other one as baseline. `levels`: of `out.methods`. Deterministic.
/// O(methods^2) tests.
void rank_methods(const Levels& levels, std::optional<std::size_t> baseline, Comparison& out);

/// Sets which ratios of sequences are significant, with Holm's correction over the sequences and
/// the methods that differ.
void test_sequences(Comparison& comparison);

/// One comparison for each score that has a direction. Deterministic. Throws InputError if the
/// baseline is not a method of the records, if `where` leaves no score, and for an unknown
/// statistic. Comparisons without a common run, or with one method, have no methods.
std::vector<Comparison> compare(const std::vector<Record>& records, const CompareOptions& options);

/// The same for observations of `options.value`.
std::vector<Comparison> compare(std::vector<Observations> all, const CompareOptions& options);

/// Which methods are best, as in compare(), but without a baseline: no ratios to it, wins and p;
/// the methods are in the order of the observations.
Comparison standings(Observations all, const CompareOptions& options);

}  // namespace loopbench::harness
