/// One score of several methods on the same runs, transformed so that lower is better.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "harness/answers/compare/typical.hpp"
#include "harness/sweep/model/record.hpp"
#include "metrics/numerics/median.hpp"

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

/// Values as levels: the error itself, its negative if higher is better, or its distance to the
/// target.
class Levels {
 public:
  /// Differences up to `tie` times the larger value are ties.
  Levels(GroupedValues all, double tie);

  std::size_t methods() const { return all_.values.size(); }
  std::size_t groups() const { return runs_of_.size(); }
  const std::vector<std::size_t>& runs_of(std::size_t group) const { return runs_of_[group]; }
  std::size_t sequence_of(std::size_t group) const {
    return all_.sequence.empty() ? group : all_.sequence[runs_of_[group].front()];
  }

  /// Whether the method was run: it has a value or failed.
  bool is_known(std::size_t method, std::size_t run) const {
    return all_.values[method][run].has_value();
  }
  bool has_value(std::size_t method, std::size_t run) const {
    return is_known(method, run) && !std::isnan(*all_.values[method][run]);
  }

  bool is_paired() const { return all_.is_paired; }

  /// Median level over the runs of a group that the method was run on, kFailed if it failed on
  /// most; none without such a run.
  std::optional<double> level(std::size_t method, std::size_t group) const;

  /// Whether differences of two methods are logarithms of ratios: neither has a value below zero.
  bool is_ratio(std::size_t a, std::size_t b) const { return is_positive_[a] && is_positive_[b]; }

  /// Difference of a level of `a` to one of `b`: negative if `a` is better, exactly 0 for a tie,
  /// +-kZeroRatio if only one of them is zero. Depends on these two methods only.
  double difference(std::size_t a, std::size_t b, double of_a, double of_b) const;

  /// The same on a run on which both have a value.
  double difference(std::size_t a, std::size_t b, std::size_t run) const {
    return difference(a, b, *all_.values[a][run], *all_.values[b][run]);
  }

  /// Whether two methods are known, fail and are tied on the same runs.
  bool are_equal(std::size_t a, std::size_t b) const;

 private:
  static constexpr double kWorst = 1e300;  // level of a failure in medians

  GroupedValues all_;  // distances to the target, if the score has one
  std::vector<bool> is_positive_;
  std::vector<std::vector<std::size_t>> runs_of_;
  double sign_ = 1.0;
  double tie_ = 0.0;
  double target_ = 0.0;  // relative to which distances to it are rounded
};

/// Errors up to this value count as zero beside an error of `largest`: rounding of coordinates,
/// 1e-9 at most, so that an error of metres is not zero beside that of a method that diverges.
inline double zero_floor(double largest) { return std::clamp(1e-9 * largest, 1e-12, 1e-9); }

inline Levels::Levels(GroupedValues all, double tie)
    : all_(std::move(all)),
      sign_(all_.better == metrics::Better::higher ? -1.0 : 1.0),
      tie_(tie),
      target_(all_.better == metrics::Better::target ? std::abs(all_.target) : 0.0) {
  for (auto& row : all_.values) {
    bool is_positive = true;
    for (std::optional<double>& cost : row) {
      if (cost && all_.better == metrics::Better::target) cost = std::abs(*cost - all_.target);
      is_positive = is_positive && !(cost && *cost < 0.0);
    }
    is_positive_.push_back(is_positive);
  }
  for (std::size_t run = 0; run < all_.group.size(); ++run) {
    if (all_.group[run] >= runs_of_.size()) runs_of_.resize(all_.group[run] + 1);
    runs_of_[all_.group[run]].push_back(run);
  }
}

inline std::optional<double> Levels::level(std::size_t method, std::size_t group) const {
  std::vector<double> known;
  for (const std::size_t run : runs_of_[group]) {
    if (!is_known(method, run)) continue;
    known.push_back(has_value(method, run) ? *all_.values[method][run] : sign_ * kWorst);
  }
  if (known.empty()) return std::nullopt;
  const double middle = metrics::median(known);
  return std::abs(middle) < 0.1 * kWorst ? middle : kFailed;
}

inline double Levels::difference(std::size_t a, std::size_t b, double of_a, double of_b) const {
  const double largest = std::max(std::abs(of_a), std::abs(of_b));
  if (std::abs(of_a - of_b) <= tie_ * std::max(largest, target_)) return 0.0;
  const double floor = zero_floor(largest);
  const bool a_zero = std::abs(of_a) <= floor;
  const bool b_zero = std::abs(of_b) <= floor;
  if (a_zero && b_zero) return 0.0;
  if (!is_ratio(a, b)) return sign_ * (of_a - of_b);
  if (a_zero != b_zero) return sign_ * (a_zero ? -kZeroRatio : kZeroRatio);
  return sign_ * (std::log(of_a) - std::log(of_b));
}

inline bool Levels::are_equal(std::size_t a, std::size_t b) const {
  for (std::size_t run = 0; run < all_.values[a].size(); ++run) {
    if (is_known(a, run) != is_known(b, run) || has_value(a, run) != has_value(b, run))
      return false;
    if (has_value(a, run) && difference(a, b, run) != 0.0) return false;
  }
  return true;
}

}  // namespace loopbench::harness
