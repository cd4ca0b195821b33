/// Detection of trajectory formats.
#pragma once

#include <optional>

#include "datasets/columns/text_file.hpp"
#include "datasets/core/fields.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

/// Guesses the format from the number of columns and the first word: g2o tags, nanoseconds and at
/// least 8 columns, 12 numbers, 4, 8, 29 or 44 numbers, or 9 with a node id.
std::optional<Format> guess(const TextFile& file, const Line& line);

/// Whether the rows have no stamps of their own: KITTI, tables with numbers of frames.
bool takes_times(const TextFile& file, Format format);

/// Detects the format from the first line of data, without consuming it. Throws InputError with the
/// line and the known formats if none matches.
Format detect_format(TextFile& file);

/// Whether a line of TUM has a ninth column, the number of a node, as RTAB-Map exports it: the
/// stamp has decimals, unlike that of EuRoC, and columns 5 to 8 are a unit quaternion.
bool has_node_id(const TextFile& file, const Line& line);

/// Returns the first line of data without consuming it. Throws InputError if there is none.
Line first_line(TextFile& file);

}  // namespace loopbench
