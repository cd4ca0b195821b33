/// Tables whose header names the columns of a pose.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Indices of the columns t, x, y, z, qw, qx, qy, qz in a row with `width` columns.
struct CsvColumns {
  std::array<std::size_t, 8> index{};
  std::size_t width = 0;
  bool nanoseconds = false;  ///< the header states that the time is in nanoseconds
};

/// Recognises names such as t, time, timestamp [ns]; x, tx, p_x, pose.position.x; qw, q_w,
/// orientation.w. Nothing if a column is missing or named twice.
std::optional<CsvColumns> csv_columns(const std::string& header);

/// Reads the columns that file.header() names. Throws InputError.
Trajectory read_csv(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
