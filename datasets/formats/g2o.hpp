/// Pose graphs in g2o text format: SE2, SE3:QUAT, RST3:QUAT (Sim(3)) and TORO's EDGE2 and EDGE3.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/core/pose.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench {

class TextFile;
class TextWriter;

/// Edges refer to vertices by their index in `ids`, not by id. from < to always: other edges are
/// inverted on reading, and their information is transformed by the adjoint.
struct PoseGraph {
  std::vector<std::int64_t> ids;   ///< ascending
  std::vector<Pose> vertices;      ///< one per id; empty if the file has no VERTEX lines
  std::vector<Edge> edges;         ///< in file order; information in twist order [rho; phi]
  std::vector<std::size_t> lines;  ///< line number of each edge, for error messages
  bool planar = false;             ///< SE2 lines, lifted to z = roll = pitch = 0
  bool similarity = false;         ///< RST3 lines, with edge.scale
  std::size_t altered = 0;         ///< edges whose information was not positive definite
  /// Edges whose information correlates the scale with the pose; these terms are not used.
  std::size_t scale_correlations = 0;
  std::vector<std::size_t> fixed = {};  ///< vertices of FIX lines, ascending
  std::vector<Anchor> priors = {};      ///< positions of PRIOR lines; Anchor::keyframe is a vertex
  std::map<std::string, std::size_t> skipped = {};  ///< number of lines that are not used, by tag
};

/// Convention of the rotation block of the information of :QUAT edges. g2o minimises the vector
/// part of the quaternion (half angles). GTSAM and SE-Sync, and papers that use them, interpret the
/// same numbers as information of angles, which is four times larger.
enum class RotationInformation { half_angles, angles };

/// Treatment of edges whose information is not positive definite (definite_information.hpp).
enum class IndefiniteInformation {
  reject,  ///< the file is an error
  repair,  ///< terms x, yaw and y, yaw stored at z, roll and z, pitch are moved (cubicle.g2o)
  project  ///< eigenvalues are raised to at least 1e-6 of the largest
};

struct InformationRules {
  RotationInformation rotation = RotationInformation::half_angles;
  IndefiniteInformation indefinite = IndefiniteInformation::reject;
};

/// Reads a g2o file. Conventions of g2o (g2o wiki and sources; TORO; COP-SLAM):
/// - Information of :QUAT edges refers to the vector part of the quaternion (half angles) and is
///   converted to twists: Omega_phi = Omega_q / 4, Omega_t,phi = Omega_tq / 2 (except for
///   RotationInformation::angles).
/// - Information that is not positive definite is treated as `rules` state, before the conversion.
/// - SE2 is lifted to SE(3): x, y, yaw are from the file; z, roll, pitch get positive diagonal
///   information, which does not affect the solution of a planar problem.
/// - VERTEX2 and EDGE2 are those of SE2; the information of EDGE2 has TORO's order xx xy yy,
///   yaw yaw, x yaw, y yaw.
/// - VERTEX3 and EDGE3 contain x y z roll pitch yaw with R = Rz(yaw) Ry(pitch) Rx(roll) and
///   information in that order, used as information of the twist. sphere2500.g2o agrees with its
///   EDGE3 original. iSAM writes square roots of information in the same format, which cannot be
///   detected.
/// - The scale column of RST3 edges is the inverse of edge.scale. With 28 numbers of information,
/// the
///   last one is edge.scale_information. Scales of vertices are checked
/// and
///   discarded.
/// - EDGE_SE3_PRIOR, EDGE_PRIOR_SE2, EDGE_PRIOR_SE2_XY, EDGE_SE2_XYPRIOR and EDGE_POINTXYZ measure
///   the position of a vertex; the covariance is the marginal one if there is a rotation.
///   EDGE_SE3_PRIOR measures that of the sensor of the PARAMS_SE3OFFSET line that it names, if any.
/// - EDGE_SE3_PRIORXY, EDGE_SE3_PRIORVEC, EDGE_SE3_PRIORQUAT and planes are counted in `skipped`.
/// - Other PARAMS lines and comments are skipped; other tags are rejected.
/// Throws InputError `file:line: what`. O(n log n) in the number of lines.
///
/// Graphs in JSON are read, too (json_graph.hpp).
PoseGraph read_g2o(const std::filesystem::path& file, const InformationRules& rules = {});
PoseGraph read_g2o(TextFile& file, const InformationRules& rules);

/// Writes vertices, FIX lines and edges, as SE2 lines if `planar`, as RST3 if `similarity`, else as
/// SE3:QUAT. read_g2o returns yaw angles and scales up to rounding, all other values bit-identical.
/// Throws InputError if the file cannot be written.
void write_g2o(const std::filesystem::path& file, const PoseGraph& graph);

/// The text of such a file.
TextWriter g2o_text(const PoseGraph& graph);

/// Stamps of all vertices: id * period [s]. Of ids that are symbols of GTSAM (a letter in the
/// highest byte, an index below) it is the index, or the position in the graph if several letters
/// share indices. Of ids from 2^53 on, which a double does not resolve, it is the number in the
/// lowest 53 bits, or the position if these do not increase.
std::vector<double> vertex_stamps(const PoseGraph& graph, double period);

/// Returns one pose per id, composed from the edges between consecutive ids, or along the fewest
/// edges if one of these is missing; the first pose is the identity. If several edges connect the
/// same vertices, the first in the file is used. Translations of a similarity graph are converted
/// to the scale of the first vertex. Throws InputError (`name: ...` with the ids) if the edges do
/// not connect them. O(edges + ids).
std::vector<Pose> chain(const PoseGraph& graph, const std::string& name = "pose graph");

}  // namespace loopbench
