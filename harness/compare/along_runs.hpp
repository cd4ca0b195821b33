/// How sure the errors of a few runs are, from the poses within them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "harness/statistics/bootstrap.hpp"

namespace loopbench {

/// Errors of two methods at the same poses of one run, in the order of travel.
struct RunErrors {
  std::vector<double> method;
  std::vector<double> baseline;
};

/// Fewest poses of a run that are worth cutting into blocks.
inline constexpr std::size_t kFewestPoses = 30;

struct AlongRuns {
  Interval ratio;           ///< geometric mean over the runs of RMSE / baseline's RMSE
  std::size_t longest = 0;  ///< block [poses]
};

/// A percentile interval over moving blocks: errors along a trajectory are correlated, so whole
/// stretches are drawn, the same for both methods, each run for itself; their length follows from
/// the autocorrelation of the difference of squared errors. It tells what the luck of the stretch
/// adds, not what another run would show. None when a run has fewer than kFewestPoses poses or a
/// method without error. O(runs * resamples * poses).
std::optional<AlongRuns> ratio_along_runs(std::span<const RunErrors> runs,
                                          const BootstrapOptions& options);

}  // namespace loopbench
