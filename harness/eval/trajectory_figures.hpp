/// Figures of trajectory files.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "harness/eval/named_trajectory.hpp"
#include "harness/report/draw.hpp"

namespace loopbench::harness {

/// One figure without files: the planes xy, xz and yz and space; x, y, z, roll, pitch, yaw and
/// speed over time. Times count from the first stamp of the reference, or of all trajectories.
FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference);

}  // namespace loopbench::harness
