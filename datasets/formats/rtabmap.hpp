/// Databases of RTAB-Map: a trajectory and a pose graph.
#pragma once

#include <filesystem>

#include "datasets/compressed/input_file.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/trajectory_file.hpp"

namespace loopbench {

/// Whether this is an SQLite file with RTAB-Map's tables Node and Link.
bool is_rtabmap(const OpenedFile& file);

/// Poses of the nodes as odometry gave them, in the order of their stamps.
///
/// Node(id, stamp, pose) has poses as 12 float32, the upper 3 x 4 block by rows; nodes without a
/// pose (such as those of an old schema) are left out. Throws InputError if no node has one.
/// O(nodes).
TrajectoryFile read_rtabmap_poses(const std::filesystem::path& file, const ReadOptions& options);

/// The same poses as vertices and the links between them as edges, with their information, in which
/// rotations are angles: neighbours, and closures (global, by proximity, of the user). A link that
/// is stored in both directions is one edge; links of a node to itself, to landmarks and to nodes
/// without a pose are left out.
///
/// Link(from_id, to_id, type, information_matrix, transform): transform as poses, information as 36
/// float64. Throws InputError for other sizes and information that is not positive definite.
/// Source: RTAB-Map 0.21, corelib/src/DBDriverSqlite3.cpp.
PoseGraph read_rtabmap_graph(const std::filesystem::path& file);

}  // namespace loopbench
