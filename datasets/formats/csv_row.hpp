/// Values in one row of a table.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

using CsvRow = std::vector<std::string_view>;

/// Splits a row. Throws InputError unless it has the columns of the header.
void split_row(const TextFile& file, const Line& line, const CsvColumns& columns, CsvRow& row);

/// The number in column `index` of a row, or in the name of an image there. Throws InputError.
double csv_number(const TextFile& file,
                  const Line& line,
                  const CsvColumns& columns,
                  const CsvRow& row,
                  std::size_t index);

/// The stated covariance. Throws InputError if it is not positive definite.
Matrix6 covariance_of_row(const TextFile& file,
                          const Line& line,
                          const CsvColumns& columns,
                          const CsvRow& row);

/// Rz(yaw) Ry(pitch) Rx(roll) or in the stated order, Rz(heading), or of a rotation vector. Throws
/// InputError for angles without a unit that are not radians.
Rotation rotation_of_angles(const TextFile& file,
                            const Line& line,
                            const CsvColumns& columns,
                            const CsvRow& row);

}  // namespace loopbench
