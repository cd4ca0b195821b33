/// Comparison of two methods, group by group.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/levels.hpp"
#include "harness/statistics/mean_interval.hpp"
#include "harness/statistics/signed_rank.hpp"

namespace loopbench::harness {

/// One entry per group on which either method has a value; negative: the first is better.
struct PairedMethods {
  /// Mean difference over the runs of the group that both have; +-kBeyond for a loss because one
  /// method fails on more runs of the group than the other; 0 for a tie.
  std::vector<double> losses_last;
  /// Mean differences of the groups with runs that both have; empty if a zero error makes the mean
  /// undefined.
  std::vector<double> common;
  bool has_zero = false;  ///< the reason why `common` is empty

  std::size_t wins = 0;  ///< groups on which the first is better
  std::size_t losses = 0;
  std::size_t ties = 0;
};

PairedMethods paired(const Levels& levels, std::size_t first, std::size_t second);

/// Mean over the groups of `common`; nullopt if it is empty.
std::optional<double> mean_difference(const PairedMethods& pair);

}  // namespace loopbench::harness
