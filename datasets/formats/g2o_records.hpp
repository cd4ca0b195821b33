/// Parsed lines of a g2o file, before they are converted to a PoseGraph.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "datasets/columns/text_file.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/g2o_priors.hpp"

namespace loopbench {

/// Kind of poses of a file: SE(2), SE(3) or Sim(3). Files with several kinds are rejected.
enum class GraphKind { planar, spatial, similarity };

struct VertexRecord {
  std::int64_t id = 0;
  Pose world_from_body;
  std::size_t line = 0;
};

/// Vertex ids as written in the file; `to` may be smaller than `from`.
struct EdgeEnds {
  std::int64_t from = 0;
  std::int64_t to = 0;
  std::size_t line = 0;
};

/// Line PARAMS_SE3OFFSET: the sensor in the body.
struct OffsetRecord {
  std::int64_t id = 0;
  Vector3 point = Vector3::Zero();  ///< its position [m]
};

struct Records {
  GraphKind kind = GraphKind::spatial;
  std::vector<VertexRecord> vertices;
  std::vector<EdgeEnds> ends;
  std::vector<Edge> edges;  ///< one per `ends`; indices not set, information of a twist
  std::vector<PriorRecord> priors;
  std::vector<OffsetRecord> offsets;
  std::vector<EdgeEnds> fixed;         ///< `from` of each
  std::size_t lines = 0;               ///< of the part of the file
  std::size_t altered = 0;             ///< edges whose information was not positive definite
  std::size_t scale_correlations = 0;  ///< edges whose scale and pose are correlated
  std::map<std::string, std::size_t> skipped = {};  ///< number of lines by tag, see is_unused_tag()
  std::vector<std::int64_t> planes = {};            ///< ids of VERTEX_PLANE lines
};

/// Reads every VERTEX, EDGE, PRIOR, PARAMS_SE3OFFSET and FIX line; other PARAMS lines are skipped.
/// Planes and priors that are not used are counted.
/// Throws InputError for unknown tags, a wrong number of columns, mixed kinds, quaternions that are
/// not unit, scales that are not positive, information that `rules` cannot make positive definite,
/// and edges from a vertex to itself.
Records read_records(TextFile& file, const InformationRules& rules);

}  // namespace loopbench
