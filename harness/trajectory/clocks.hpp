/// Stamps of several trajectories on one clock.
#pragma once

#include <string>

#include "harness/trajectory/named_trajectory.hpp"

namespace loopbench::harness {

/// Adds `offset` [s] to all stamps; exact ones are shifted by whole nanoseconds.
void shift_stamps(TrajectoryFile& file, double offset);

/// Why two trajectories have no common clock: only one of them has stamps, and `arguments` state no
/// period for the other one. Empty if there is no reason.
std::string why_no_common_clock(const NamedTrajectory& a,
                                const NamedTrajectory& b,
                                const ReadArguments& arguments);

/// "assumed 0.1 s between poses" for a file without stamps and a period that is not stated;
/// otherwise empty.
std::string assumed_period(const TrajectoryFile& file, const ReadArguments& arguments);

}  // namespace loopbench::harness
