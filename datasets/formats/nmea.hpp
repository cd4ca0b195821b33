/// Sentences of GNSS receivers (NMEA 0183): GGA and RMC as positions.
#pragma once

#include "datasets/columns/reading.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Whether a line is a sentence: "$GPGGA,...".
bool is_nmea(const Line& line);

/// Positions of GGA, or of RMC where a file has no GGA, in metres at the first one; other sentences
/// are skipped. Stamps are seconds since 1970 with the date of RMC, and otherwise seconds since the
/// first midnight. Heights are above the ellipsoid, 0 without GGA. Sentences without a fix are
/// counted; those with a wrong checksum are invalid rows. Throws InputError. O(n).
Trajectory read_nmea(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
