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

/// What the rotation part of a :QUAT edge's information is about. g2o minimises the quaternion's
/// vector part, half angles; GTSAM, SE-Sync and the papers that use them take the same numbers for
/// angles, four times as sure.
enum class TurnInformation { half_angles, angles };

/// How each kind of line is read (g2o's wiki and sources; TORO; COP-SLAM):
/// - information of :QUAT edges is stored for the quaternion's vector part (half angles) and is
///   converted to twists: Omega_phi = Omega_q / 4, Omega_t,phi = Omega_tq / 2 (unless told that it
///   is about angles);
/// - SE2 is lifted: x, y, yaw from the file, z, roll, pitch with a positive diagonal of their own,
///   which a planar problem never feels;
/// - VERTEX3, EDGE3 hold x y z roll pitch yaw with R = Rz(yaw) Ry(pitch) Rx(roll), information in
///   that order, taken as that of the twist. sphere2500.g2o agrees with its EDGE3 original; iSAM,
///   though, writes square roots of information there, which no reader can tell;
/// - the scale column of RST3 edges is the length unit of the first id over that of the second, the
///   other way round than edge.scale; vertices' scales are checked and not kept;
/// - FIX and # lines are passed over; any other tag is refused.
/// Throws InputError `file:line: what`. O(n log n) in the number of lines.
PoseGraph read_g2o(const std::filesystem::path& file,
                   TurnInformation turns = TurnInformation::half_angles);

/// Writes vertices and edges so that read_g2o returns them: SE2 lines when `planar`, RST3 when
/// `similarity`, else SE3:QUAT. Yaw angles and scales come back to rounding, the rest to the bit.
/// Throws InputError when the file cannot be written.
void write_g2o(const std::filesystem::path& file, const PoseGraph& graph);

}  // namespace loopbench
