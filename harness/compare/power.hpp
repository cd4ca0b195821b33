/// Smallest gains that a comparison can find.
#pragma once

#include <cstddef>
#include <map>

namespace loopbench::harness {

/// Gains that the test finds with a probability of 80 %, for normal log ratios.
class Power {
 public:
  /// `alpha` is that of one test, after the correction for their number. `strata`: sequences whose
  /// runs are independent; "groups" are then the runs of either method on each of them.
  explicit Power(double alpha, std::size_t strata = 0) : alpha_(alpha), strata_(strata) {}

  /// The smallest mean log ratio over its standard deviation (of two runs, if these are
  /// independent); infinite if no number of equal signs is significant. Signed ranks: up to 200
  /// groups by simulation with fixed draws, beyond by the test's asymptotic efficiency; rank sums:
  /// by the normal approximation of Noether (1987). O(groups log groups), remembered.
  double smallest_effect(std::size_t groups);

  /// The fewest groups that find this mean over standard deviation; at most `kMostGroups`, which
  /// means that or more.
  std::size_t groups_needed(double effect);

  static constexpr std::size_t kMostGroups = 100'000;

 private:
  double smallest_of_strata(std::size_t runs) const;

  double alpha_;
  std::size_t strata_;
  std::map<std::size_t, double> known_;
};

}  // namespace loopbench::harness
