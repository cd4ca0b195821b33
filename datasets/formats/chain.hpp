/// Initial poses for a pose graph without VERTEX lines.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// Returns one pose per id, composed from the edges between consecutive ids; the first pose is the
/// identity. If several edges connect the same vertices, the first in the file is used.
/// Translations of a similarity graph are converted to the scale of the first vertex. Throws
/// InputError (`name: ...` with the ids) if consecutive ids have no edge. O(edges + ids).
std::vector<Pose> chain(const PoseGraph& graph, const std::string& name = "pose graph");

}  // namespace loopbench
