/// TUM RGB-D text: `stamp tx ty tz qx qy qz qw` of world_from_body, in seconds (or nanoseconds, see
/// Format) and metres.
#pragma once

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Throws InputError. Source: TUM RGB-D benchmark, file formats.
Trajectory read_tum(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
