/// KITTI odometry: the upper 3 x 4 block of world_from_camera row by row, 12 columns, or the 4 x 4
/// matrix. A column more is a stamp, or the number of a frame (has_frame_numbers()). Without
/// stamps, they are multiples of the period for the row or frame, or its line of a times file.
/// Rotations must be orthonormal within 0.05 and are converted to unit quaternions; a scale is
/// removed from them, and the findings state both. Source: KITTI odometry devkit.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/core/pose.hpp"

namespace loopbench {

/// Reads the same poses as matrices with the digits of the file. Throws InputError. O(n).
std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& file);

}  // namespace loopbench
