/// Layouts that are recognised by their numbers, also those without a reader.
#pragma once

#include <cstddef>
#include <string_view>

#include "datasets/columns/text_file.hpp"

namespace loopbench {

/// Sum of the squares of `count` columns behind the first ones; not a number if one is no number.
double square_of_columns(const TextFile& file, const Line& line, std::size_t first, int count);

/// EuRoC stamps are nanoseconds since 1970: no decimal point, and more digits than microseconds.
bool is_nanoseconds(std::string_view word);

/// Whether a sum of squares is that of a unit vector or quaternion.
bool is_unit_square(double square);

/// Whether the first lines are the rows of a 4 x 4 matrix, perhaps below a line of numbers.
bool has_matrix_lines(const TextFile& file);

/// A number, a quaternion, a position, the number of a camera, and a name: images.txt of COLMAP.
bool is_of_colmap(const TextFile& file, const Line& line);

/// Throws InputError with the command that converts a file, if it has a known layout without a
/// reader.
void reject_known(const TextFile& file, const Line& line);

}  // namespace loopbench
