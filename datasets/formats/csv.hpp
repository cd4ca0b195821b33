/// Tables whose header names the columns of a pose.
#pragma once

#include <optional>
#include <string_view>

#include "datasets/formats/csv_header.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/stamps.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// The columns that file.header() names, otherwise those of the comment above the first row if it
/// names all columns of this row. Call after skip_header().
std::optional<CsvColumns> csv_columns(const TextFile& file);

/// The stamp of one row. Throws InputError.
ReadStamp csv_stamp(const TextFile& file, const Line& line, const CsvColumns& columns);

/// Reads the columns that the header names. Throws InputError.
Trajectory read_csv(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
