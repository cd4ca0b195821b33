/// Pairs of poses of two trajectories, as `traj sync` and `traj align` need them.
#pragma once

#include <vector>

#include "harness/commands/traj_options.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::harness {

/// Throws InputError if only one of two trajectories has stamps.
void reject_two_clocks(const TrajArguments& a,
                       const NamedTrajectory& one,
                       const NamedTrajectory& other);

/// Indices of paired poses. Throws InputError if there are none, or no common clock.
std::vector<metrics::IndexPair> paired_indices(const TrajArguments& a,
                                               const NamedTrajectory& reference,
                                               const NamedTrajectory& estimate);

/// The paired poses of one trajectory.
TrajectoryFile paired_part(const TrajectoryFile& file,
                           const std::vector<metrics::IndexPair>& pairs,
                           std::size_t metrics::IndexPair::*index);

}  // namespace loopbench::harness
