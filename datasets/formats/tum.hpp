/// TUM RGB-D: `stamp tx ty tz qx qy qz qw` of world_from_body, in seconds (or another unit, see
/// fitting_units()) and metres. Source: TUM RGB-D benchmark, file formats.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/text_writer.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

/// The text of a file, with `comments` as `# ` lines at the top.
TextWriter tum_text(const TrajectoryFile& file, const std::vector<std::string>& comments);

}  // namespace loopbench
