/// Keyframes that LIO-SAM and LeGO-LOAM save as a point cloud (transformations.pcd).
#pragma once

#include "datasets/compressed/input_file.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

/// Whether the file begins as a point cloud of the PCD format.
bool is_pcd(const OpenedFile& file);

/// Reads the fields x, y, z [m], roll, pitch, yaw [rad], R = Rz(yaw) Ry(pitch) Rx(roll), and time
/// [s]; others are skipped. DATA ascii or binary, numbers of type F. Throws InputError, also for
/// binary_compressed and stamps that do not increase. O(bytes). Source: the PCD file format of the
/// Point Cloud Library, version 0.7; LIO-SAM, include/utility.h (PointXYZIRPYT).
Trajectory read_pcd(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace loopbench
