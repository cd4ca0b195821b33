/// KITTI odometry poses: the upper 3 x 4 block of world_from_camera row by row, 12 columns.
#pragma once

#include "datasets/core/pose_matrix.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Reads poses. Stamps are read from options.times or, if it is not set, are multiples of
/// options.period. Rotations must be orthonormal within 1e-3 and are converted to unit quaternions.
/// Throws InputError, also if the numbers of poses and times differ. Source: KITTI odometry devkit.
Trajectory read_kitti(TextFile& file, const ReadOptions& options);

/// Reads the same poses as matrices with the digits of the file. Throws InputError. O(n).
std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& file);

/// Reads strictly increasing times [s], one per line. Throws InputError.
std::vector<double> read_times(const std::filesystem::path& file);

}  // namespace loopbench
