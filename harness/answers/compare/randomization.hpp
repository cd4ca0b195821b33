/// Test of the mean over strata of typical differences, and the interval that inverts it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "harness/answers/compare/typical.hpp"

namespace loopbench::harness {

/// Values of one sequence.
struct Stratum {
  std::vector<double> first;        ///< differences of pairs, or values of the first sample
  std::vector<double> second = {};  ///< values of the second, independent sample; empty: pairs

  bool is_paired() const { return second.empty(); }
};

/// Hodges-Lehmann estimate of the differences of pairs; of independent samples the median of all
/// differences of two values.
double typical_of(const Stratum& stratum);

/// Sum over the strata of the differences (see below), and its two-sided p.
struct Exchanged {
  double sum = 0.0;
  double p = 1.0;
};

/// Randomization test of the hypothesis that the mean over the strata, each of which counts once,
/// is `shift`.
///
/// Statistic: mean over the strata of the mean of the differences, which are clipped at twice their
/// typical size, values of samples at four times that (a few outliers do not decide; the size is
/// shrunk to that of all strata) and divided by the share that is not clipped. Its distribution is
/// that under all exchanges of the two methods, sign flips of pairs or exchanges of labels within
/// strata; p is twice the smaller tail. That is exact where the methods do not differ on any
/// stratum. For several strata p is not below that of Student's test of the same scores with a
/// variance of each stratum (Welch, Satterthwaite), because a mean can be zero over strata that
/// differ, and one noisy stratum of few values decides it. Deterministic. O(n log n); all exchanges
/// of up to 16 pairs, or 2^20 of samples, are enumerated.
Exchanged exchanged(std::vector<Stratum> strata, double shift);

/// The same test about typical values: p is 1 where the statistic and typical() - shift have
/// different signs, so that estimate, interval and p never contradict each other.
/// Strata whose typical value is known to differ from the mean are first moved towards it, because
/// a difference between sequences is no scatter.
class RandomizationTest {
 public:
  /// All strata are pairs, or none is; each has a value (of both samples).
  explicit RandomizationTest(std::vector<Stratum> strata);

  /// Mean over the strata of typical_of().
  double typical() const { return typical_; }

  /// The smallest p that values of these numbers can have.
  double least_p() const;

  /// Of the hypothesis that the mean over the strata is `shift`.
  double p(double shift = 0.0) const;

  /// typical(), and the shifts with p > level; nullopt if there are too few values. It excludes 0
  /// exactly if p() <= level. About 50 calls of p().
  std::optional<Interval> interval(double level) const;

 private:
  double end(double level, double outward) const;

  std::vector<Stratum> strata_;
  double typical_ = 0.0;
};

/// The smallest p of `count` pairs, or of so many runs of each method in each of `strata`
/// sequences.
double least_p_of(std::size_t count, std::size_t strata);

}  // namespace loopbench::harness
