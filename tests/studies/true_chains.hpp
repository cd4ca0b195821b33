/// Odometry chains with the true pose of each keyframe, recorded and simulated.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

struct TrueChain {
  std::string name;
  Problem problem;             ///< without closures; odometry with its true mean deviations
  Trajectory truth;            ///< of each keyframe
  std::vector<Edge> revisits;  ///< true relative poses, without noise, ascending in (to, from)
  double sigma_t = 0.0;        ///< of closures [m]
  double sigma_r = 0.0;        ///< [rad]
};

/// Chains of the data folder, at most 400 keyframes each, in a fixed order. Keyframes without a
/// true pose are left out.
std::vector<TrueChain> recorded_chains(const std::filesystem::path& data);

/// Simulated drives and rooms with seeds from `first` on.
std::vector<TrueChain> simulated_chains(std::int64_t first, int count);

/// The chain with a constant bias of the odometry: distances are 2 % too long, and its yaw rate is
/// 0.02 deg/s off, about the axis of the least extent of the true positions. The bias is part of
/// the mean deviations that are stated.
TrueChain biased(TrueChain chain);

}  // namespace loopbench
