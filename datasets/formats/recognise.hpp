/// Which format a line of data shows.
#pragma once

#include <optional>

#include "datasets/core/fields.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// By its column count and first word: g2o tags, 12 numbers, nanoseconds first, 8 numbers.
std::optional<Format> guess(const TextFile& file, const Line& line);

/// The format of the first line of data, which is put back. Throws InputError when the line
/// shows none, saying what it looks like and what is known.
Format recognise(TextFile& file);

/// Whether the first two stamps are whole numbers at least 1e5 apart: nanoseconds of a clock that
/// starts near 0, as simulators write them, at 10 kHz or less. In seconds that is more than a day.
bool has_small_nanoseconds(const TextFile& file);

/// The line that next() will give. Refuses a file without one.
Line first_line(TextFile& file);

}  // namespace loopbench
