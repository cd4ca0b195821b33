/// TUM RGB-D text: `stamp tx ty tz qx qy qz qw`, world_from_body, seconds (or nanoseconds, see
/// Format) and metres.
#pragma once

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Source: TUM RGB-D benchmark, file formats. Throws InputError.
Trajectory read_tum(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
