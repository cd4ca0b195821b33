/// Pose graphs in g2o text: SE2, SE3:QUAT, RST3 (Sim(3) chains) and TORO's EDGE3.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench {

/// Edges name vertices by their index in `ids`, not by id. from < to always: an edge written the
/// other way round is inverted and its information carried along by the adjoint.
struct PoseGraph {
  std::vector<std::int64_t> ids;   ///< ascending
  std::vector<Pose> vertices;      ///< one per id; empty when the file has no VERTEX lines
  std::vector<Edge> edges;         ///< in file order; information in twist order [rho; phi]
  std::vector<std::size_t> lines;  ///< line of each edge, for messages
  bool planar = false;             ///< SE2 lines, lifted to z = roll = pitch = 0
  bool similarity = false;         ///< RST3 lines; edge.scale is then meaningful
};

/// Information of EDGE_SE3:QUAT is stored for the quaternion's vector part (half angles) and is
/// converted to twists here. Throws InputError `file:line: what`. O(size of the file).
PoseGraph read_g2o(const std::filesystem::path& file);

/// Writes vertices and edges so that read_g2o returns them. SE2 lines when `planar`.
void write_g2o(const std::filesystem::path& file, const PoseGraph& graph);

}  // namespace loopbench
