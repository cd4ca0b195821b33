/// One line of a g2o file with a vertex, an edge or the parameter of a sensor.
#pragma once

#include <string_view>

#include "datasets/formats/g2o_records.hpp"

namespace loopbench {

/// Numbers of the pose on a line.
enum class PoseLayout { se2, quaternion, euler, quaternion_and_scale };

/// First word of a line with a vertex or an edge.
struct PoseTag {
  std::string_view word;
  PoseLayout pose;
  const char* columns;  ///< for error messages

  bool is_edge() const { return word.starts_with("EDGE"); }
  GraphKind kind() const {
    if (pose == PoseLayout::se2) return GraphKind::planar;
    return pose == PoseLayout::quaternion_and_scale ? GraphKind::similarity : GraphKind::spatial;
  }
};

/// The tag that is `word`. Throws InputError for others, with what to do about those that other
/// programs write.
const PoseTag& find_pose_tag(const TextFile& file, const Line& line, std::string_view word);

/// Reads a line of a vertex. Throws InputError with the columns that its tag requires.
VertexRecord read_vertex(const TextFile& file, const Line& line, const PoseTag& tag);

/// Adds a line of an edge. Throws InputError as read_vertex(), for information that `rules` cannot
/// make positive definite, and for an edge from a vertex to itself.
void read_edge(const TextFile& file,
               const Line& line,
               const PoseTag& tag,
               const InformationRules& rules,
               Records& out);

/// Reads a line PARAMS_SE3OFFSET. The rotation of the sensor has no effect on its position.
OffsetRecord read_offset(const TextFile& file, const Line& line);

}  // namespace loopbench
