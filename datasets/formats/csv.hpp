/// Tables whose header, or the comment above them, names time, position and quaternion.
#pragma once

#include <optional>

#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/reading.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/columns/text_file.hpp"

namespace loopbench {

/// The columns that file.header() names, otherwise those of the comment above the first row if it
/// names all columns of this row, or those of `ros2 topic echo --csv`. Call after skip_header().
std::optional<CsvColumns> csv_columns(const TextFile& file);

/// The column of the stamps: the first one, except in tables with a header.
std::size_t time_column(const TextFile& file, Format format);

/// The stamp of one row, in units of 10^exponent seconds.
ReadStamp csv_stamp(const TextFile& file,
                    const Line& line,
                    const CsvColumns& columns,
                    int exponent);

/// The exponent of the stamps of a table.
int csv_exponent(const TextFile& file, const CsvColumns& columns, const ReadOptions& options);

}  // namespace loopbench
