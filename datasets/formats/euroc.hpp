/// EuRoC state csv: `timestamp [ns], p xyz [m], q wxyz, ...`, world_from_body.
#pragma once

#include <cstdint>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Needs at least 8 columns, as many on every line; those past the attitude are not looked at.
/// Source: EuRoC MAV dataset, ASL format. Throws InputError.
Trajectory read_euroc(TextFile& file, const ReadOptions& options);

/// [s]. Whole seconds apart from the rest, because nanoseconds since 1970 do not fit 53 bits.
double seconds_of(std::int64_t nanoseconds);

}  // namespace loopbench
