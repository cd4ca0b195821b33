/// One score of several methods on the same runs, transformed so that lower is better.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "harness/model/record.hpp"

namespace loopbench::harness {

/// Value of a run on which a method failed.
inline constexpr double kFailed = std::numeric_limits<double>::quiet_NaN();

struct GroupedValues {
  /// [method][run]: a value, kFailed, or none: not run or declined, no observation.
  std::vector<std::vector<std::optional<double>>> values;
  std::vector<std::size_t> group;     ///< of each run, numbered from 0
  std::vector<std::size_t> sequence;  ///< of each run, numbered from 0; empty: one each
  metrics::Better better = metrics::Better::lower;
  double target = 0.0;
  bool is_paired = true;  ///< false: runs of two methods share a sequence, but nothing else
};

/// Errors up to this value count as zero beside an error of `largest`: rounding of coordinates,
/// 1e-9 at most, so that an error of metres is not zero beside that of a method that diverges.
double zero_floor(double largest);

/// Values as levels: the error itself, its negative if higher is better, or its distance to the
/// target.
class Levels {
 public:
  /// Differences up to `tie` times the larger value are ties.
  Levels(const GroupedValues& all, double tie);

  std::size_t methods() const { return costs_.size(); }
  std::size_t groups() const { return runs_of_.size(); }
  const std::vector<std::size_t>& runs_of(std::size_t group) const { return runs_of_[group]; }
  std::size_t sequence_of(std::size_t group) const;

  /// Whether the method was run: it has a value or failed.
  bool is_known(std::size_t method, std::size_t run) const {
    return costs_[method][run].has_value();
  }
  bool has_value(std::size_t method, std::size_t run) const;

  /// Number of groups with a run that the method was run on.
  std::size_t known_groups(std::size_t method) const;

  bool is_paired() const { return is_paired_; }

  /// Median level over the runs of a group that the method was run on, kFailed if it failed on
  /// most; none without such a run.
  std::optional<double> level(std::size_t method, std::size_t group) const;

  /// Whether differences of two methods are logarithms of ratios: neither has a value below zero.
  bool is_ratio(std::size_t a, std::size_t b) const { return is_positive_[a] && is_positive_[b]; }

  /// Difference of a level of `a` to one of `b`: negative if `a` is better, exactly 0 for a tie,
  /// +-kNoRatio if only one of them is zero or failed. Depends on these two methods only.
  double difference(std::size_t a, std::size_t b, double of_a, double of_b) const;

  /// The same on a run on which both were run.
  double difference(std::size_t a, std::size_t b, std::size_t run) const {
    return difference(a, b, *costs_[a][run], *costs_[b][run]);
  }

  /// Whether two methods are known, fail and are tied on the same runs.
  bool are_equal(std::size_t a, std::size_t b) const;

 private:
  std::vector<std::vector<std::optional<double>>> costs_;
  std::vector<bool> is_positive_;
  std::vector<std::vector<std::size_t>> runs_of_;
  std::vector<std::size_t> sequence_;  // of each run
  double sign_ = 1.0;
  double tie_ = 0.0;
  double target_ = 0.0;  // relative to which distances to it are rounded
  bool is_paired_ = true;
};

}  // namespace loopbench::harness
