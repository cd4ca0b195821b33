/// EuRoC state csv: `timestamp [ns], p xyz [m], q wxyz, ...` of world_from_body.
#pragma once

#include <cstdint>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Requires at least 8 columns and the same number on every line; columns after the quaternion are
/// ignored. Throws InputError. Source: EuRoC MAV dataset, ASL format.
Trajectory read_euroc(TextFile& file, const ReadOptions& options);

/// Converts to [s]. Seconds and remainder are converted separately, because nanoseconds since 1970
/// exceed 53 bits.
double seconds_of(std::int64_t nanoseconds);

}  // namespace loopbench
