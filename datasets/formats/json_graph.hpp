/// Pose graphs in JSON: those of Open3D, and JSON Robot Logs (JRL, as of COSMO-Bench).
#pragma once

#include <filesystem>

#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// Whether the file begins as one of them. O(1).
bool is_json_graph(const std::filesystem::path& file);

/// Reads such a file; `rules.rotation` has no effect, because information is that of angles.
/// - Open3D: `transformation` of an edge maps points of the source node to the target node,
/// matrices
///   are stored by columns, information has rotations first. Ids are numbers of nodes. `confidence`
///   and `uncertain` are not used.
/// - JRL: BetweenFactorPose2 and BetweenFactorPose3 of all robots are edges, PriorFactorPose2 and
///   PriorFactorPose3 measure positions. Covariances have rotations first in space and last in the
///   plane, as in GTSAM. Vertices are those of `initialization`, if it has all of them. Other
///   measurements are counted in PoseGraph::skipped, `groundtruth` is not read.
/// Throws InputError with the name of the file and the entry.
PoseGraph read_json_graph(const std::filesystem::path& file, const InformationRules& rules);

}  // namespace loopbench
