/// The lines of a g2o file, one by one, before they become a graph.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/formats/g2o.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

/// What a file measures in; one file has one kind.
enum class GraphKind { planar, spatial, similarity };

struct VertexRecord {
  std::int64_t id = 0;
  Pose world_from_body;
  std::size_t line = 0;
};

/// As written: `to` may come before `from`.
struct EdgeEnds {
  std::int64_t from = 0;
  std::int64_t to = 0;
  std::size_t line = 0;
};

struct Records {
  GraphKind kind = GraphKind::spatial;
  std::vector<VertexRecord> vertices;
  std::vector<EdgeEnds> ends;
  std::vector<Edge> edges;  ///< one per `ends`; indices not set, information that of a twist
};

/// Every VERTEX and EDGE line; FIX lines are passed over. Throws InputError: unknown tags, wrong
/// columns, kinds mixed, quaternions not unit, scales not positive, information not positive
/// definite, edges from a vertex to itself.
Records read_records(TextFile& file, TurnInformation turns);

}  // namespace loopbench
