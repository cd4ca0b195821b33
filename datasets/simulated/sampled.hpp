/// Sampling of a simulated path at a constant rate.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

inline constexpr std::size_t kMostSamplesKept = 100'000;  // [poses], 6.4 MB

/// Returns poses at k / rate from 0 to `seconds`, projected to x, y, yaw if `planar`. The last
/// result is cached, because repetitions with other noise use the same path and its evaluation
/// dominates the run time. Thread-safe. Throws OptionError for more than 1e8 poses. O(poses).
Trajectory sampled(SimulatedPath which, double rate, double seconds, bool planar);

}  // namespace loopbench
