/// Figures of trajectory files.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "harness/plot/gnuplot.hpp"
#include "harness/trajectory/named_trajectory.hpp"

namespace loopbench::harness {

/// Panels of one curve for each trajectory: the planes xy, xz and yz and space, with start and end
/// marked; x, y, z, roll, pitch, yaw and speed over time. Times count from the first stamp of the
/// reference, or of all trajectories.
std::vector<PlotPanel> trajectory_panels(const std::vector<NamedTrajectory>& all,
                                         const std::optional<NamedTrajectory>& reference);

/// Writes these panels to an SVG, PDF or PNG file. Throws InputError like write_figure(), and for
/// another extension.
void write_trajectory_figure(const std::filesystem::path& file,
                             const std::vector<NamedTrajectory>& all,
                             const std::optional<NamedTrajectory>& reference);

/// Throws InputError unless the extension is .svg, .pdf or .png.
void check_figure_name(const std::filesystem::path& file);

}  // namespace loopbench::harness
