/// Readers of text formats with one pose per line. All throw InputError.
#pragma once

#include <optional>

#include "datasets/core/pose.hpp"
#include "datasets/formats/csv_header.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/stamps.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// KITTI odometry: the upper 3 x 4 block of world_from_camera row by row, 12 columns. Stamps are
/// read from options.times or, if it is not set, are multiples of options.period. Rotations must be
/// orthonormal within 1e-3 and are converted to unit quaternions.
/// Throws InputError also if the numbers of poses and times differ. Source: KITTI odometry devkit.
Trajectory read_kitti(TextFile& file, const ReadOptions& options);

/// Reads the same poses as matrices with the digits of the file. O(n).
std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& file);

/// Reads strictly increasing times [s], one per line.
std::vector<double> read_times(const std::filesystem::path& file);

/// TUM RGB-D: `stamp tx ty tz qx qy qz qw` of world_from_body, in seconds (or nanoseconds, see
/// Format) and metres. Source: TUM RGB-D benchmark, file formats.
Trajectory read_tum(TextFile& file, const ReadOptions& options);

/// The columns that file.header() names, otherwise those of the comment above the first row if it
/// names all columns of this row. Call after skip_header().
std::optional<CsvColumns> csv_columns(const TextFile& file);

/// The stamp of one row.
ReadStamp csv_stamp(const TextFile& file, const Line& line, const CsvColumns& columns);

/// Reads the columns that the header names.
Trajectory read_csv(TextFile& file, const ReadOptions& options);

/// EuRoC state csv: `timestamp [ns], p xyz [m], q wxyz, ...` of world_from_body. Requires at least
/// 8 columns and the same number on every line; columns after the quaternion are ignored. Source:
/// EuRoC MAV dataset, ASL format.
Trajectory read_euroc(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
