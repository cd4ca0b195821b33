/// Smallest gains that a comparison can find.
#pragma once

#include <cstddef>
#include <map>

namespace loopbench::harness {

/// Gains that the signed-rank test finds with a probability of 80 %, for normal log ratios.
class Power {
 public:
  /// `alpha` is that of one test, after the correction for their number.
  explicit Power(double alpha) : alpha_(alpha) {}

  /// The smallest mean log ratio over its standard deviation; infinite if no number of equal signs
  /// is significant. Up to 200 groups by simulation with fixed draws, beyond by the test's
  /// asymptotic efficiency. O(groups log groups), remembered.
  double smallest_effect(std::size_t groups);

  /// The fewest groups that find this mean over standard deviation; at most `kMostGroups`, which
  /// means that or more.
  std::size_t groups_needed(double effect);

  static constexpr std::size_t kMostGroups = 100'000;

 private:
  double alpha_;
  std::map<std::size_t, double> known_;
};

}  // namespace loopbench::harness
