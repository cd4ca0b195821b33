/// Readers of text formats with one pose per line. All throw InputError.
#pragma once

#include <optional>

#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/pose.hpp"
#include "datasets/formats/formats.hpp"

namespace loopbench {

/// KITTI odometry: the upper 3 x 4 block of world_from_camera row by row, 12 columns, or the 4 x 4
/// matrix. A column more is a stamp, or the number of a frame (has_frame_numbers()). Without
/// stamps, they are multiples of options.period for the row or frame, or its line of options.times.
/// Rotations must be orthonormal within 1e-3 and are converted to unit quaternions. Throws
/// InputError also if options.times does not fit. Source: KITTI odometry devkit.
Trajectory read_kitti(TextFile& file, const ReadOptions& options);

/// Reads the same poses as matrices with the digits of the file. O(n).
std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& file);

/// Reads strictly increasing times, one per line, with the unit and order of the options.
std::vector<double> read_times(const std::filesystem::path& file, const ReadOptions& options);

/// Replaces the numbers of rows or frames in `poses`, as repaired.clock states, by the times of the
/// options, or by multiples of the period.
void set_stamps(const TextFile& file, const ReadOptions& options, Trajectory& poses);

/// TUM RGB-D: `stamp tx ty tz qx qy qz qw` of world_from_body, in seconds (or another unit, see
/// fitting_units()) and metres. Source: TUM RGB-D benchmark, file formats.
Trajectory read_tum(TextFile& file, const ReadOptions& options);

/// The columns that file.header() names, otherwise those of the comment above the first row if it
/// names all columns of this row, or those of `ros2 topic echo --csv`. Call after skip_header().
std::optional<CsvColumns> csv_columns(const TextFile& file);

/// The stamp of one row, in units of 10^exponent seconds.
ReadStamp csv_stamp(const TextFile& file,
                    const Line& line,
                    const CsvColumns& columns,
                    int exponent);

/// The exponent of the stamps of a table.
int csv_exponent(const TextFile& file, const CsvColumns& columns, const ReadOptions& options);

/// Reads the columns that the header names.
Trajectory read_csv(TextFile& file, const ReadOptions& options);

/// EuRoC state csv: `timestamp [ns], p xyz [m], q wxyz, ...` of world_from_body. Requires at least
/// 8 columns and the same number on every line; columns after the quaternion are ignored. Source:
/// EuRoC MAV dataset, ASL format.
Trajectory read_euroc(TextFile& file, const ReadOptions& options);

}  // namespace loopbench
