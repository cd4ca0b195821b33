/// Vertices for a pose graph that has only edges.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/formats/g2o.hpp"

namespace loopbench {

/// One pose per id by chaining the edges that join neighbours in `ids`, the first at the origin.
/// Where two edges join the same neighbours the first in the file counts. Scales of a similarity
/// graph are carried along: the result is in the first vertex's unit.
/// Throws InputError, `name: ...` with the ids, when neighbours have no edge. O(edges + ids).
std::vector<Pose> chain(const PoseGraph& graph, const std::string& name = "pose graph");

}  // namespace loopbench
