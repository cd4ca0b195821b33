/// Figures of trajectory files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/eval/named_trajectory.hpp"
#include "harness/report/draw.hpp"

namespace loopbench::harness {

/// The plane of the largest extent and space; x, y, z, roll, pitch, yaw and speed over time. Any
/// panel can also be xy, xz or yz.
inline std::vector<std::string> usual_trajectory_panels() {
  return {"plane", "xyz", "x", "y", "z", "roll", "pitch", "yaw", "speed"};
}

/// One figure without files. Names without a label are file names without folder and extension, if
/// these differ. Times count from the first stamp of the reference, or of all
/// trajectories.
FigureData trajectory_figure(const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference,
                             const std::vector<std::string>& panels,
                             const FigureOptions& options);

}  // namespace loopbench::harness
