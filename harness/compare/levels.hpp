/// One score of several methods on the same runs, transformed so that lower is better.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

struct GroupedValues {
  std::vector<std::vector<std::optional<double>>> values;  ///< [method][run]; none: failed, a loss
  std::vector<std::size_t> group;                          ///< of each run, numbered from 0
  metrics::Better better = metrics::Better::lower;
  double target = 0.0;
};

/// Difference to a failure or to an error of zero, for which no ratio exists.
inline constexpr double kBeyond = 1e300;

/// Errors up to this value count as zero beside an error of `largest`: rounding of coordinates,
/// 1e-9 at most, so that an error of metres is not zero beside that of a method that diverges.
double zero_floor(double largest);

/// Values as levels: the error itself, its negative if higher is better, or its distance to the
/// target. Logarithmic if no value is negative, so that runs with errors of metres do not dominate
/// runs with errors of centimetres.
class Levels {
 public:
  /// Differences up to `relevant` times the larger value are ties.
  Levels(const GroupedValues& all, double relevant);

  bool is_ratio() const { return is_ratio_; }
  std::size_t methods() const { return costs_.size(); }
  std::size_t groups() const { return runs_of_.size(); }
  const std::vector<std::size_t>& runs_of(std::size_t group) const { return runs_of_[group]; }
  bool has(std::size_t method, std::size_t run) const { return costs_[method][run].has_value(); }

  /// Level of `a` minus level of `b` if both have a value: negative if `a` is better, exactly 0 for
  /// a tie, +-kBeyond if only one of them is zero. Depends on these two methods only.
  double difference(std::size_t a, std::size_t b, std::size_t run) const;

  /// Sort key of methods: mean over groups of the mean level over a group's runs. A failed run
  /// counts as twice the worst error on it (without ratios, as far beyond the worst as that is from
  /// the best). O(runs * methods).
  double standing(std::size_t method) const;

 private:
  double level(std::size_t method, std::size_t run) const { return levels_[method][run]; }
  double level_of_failure(std::size_t run) const;

  std::vector<std::vector<std::optional<double>>> values_;
  std::vector<std::vector<std::optional<double>>> costs_;
  std::vector<std::vector<std::size_t>> runs_of_;
  std::vector<std::vector<double>> levels_;  // of the costs
  double sign_ = 1.0;
  double relevant_ = 0.0;
  bool is_ratio_ = true;
};

}  // namespace loopbench::harness
