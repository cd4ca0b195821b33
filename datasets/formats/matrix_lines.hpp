/// Matrices over several lines.
#pragma once

#include "datasets/columns/text_file.hpp"
#include "datasets/core/pose.hpp"

namespace loopbench {

/// Reads a 3 x 4 or 4 x 4 matrix over three or four lines, of which `line` is the first, and nan or
/// inf as such. The last line of a file can be missing if it is 0 0 0 1. Throws InputError.
PoseMatrix read_matrix_lines(TextFile& file, const Line& line);

}  // namespace loopbench
