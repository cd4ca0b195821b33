/// KITTI odometry poses: the upper 3 x 4 of world_from_camera, row by row, 12 columns.
#pragma once

#include "datasets/core/pose_matrix.hpp"
#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// Stamps come from options.times, else options.period apart from 0. Rotations must be orthonormal
/// within 1e-3 and become the unit quaternion nearest to them. Source: KITTI odometry devkit.
/// Throws InputError, also when poses and times differ in number.
Trajectory read_kitti(TextFile& file, const ReadOptions& options);

/// The matrices with the digits of the file, by the same rules and as many as read_kitti gives
/// poses. Throws InputError. O(n).
std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& file);

/// Strictly increasing seconds, one a line. Throws InputError.
std::vector<double> read_times(const std::filesystem::path& file);

}  // namespace loopbench
