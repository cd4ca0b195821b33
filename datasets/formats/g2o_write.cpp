#include <cmath>

#include "datasets/formats/g2o.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/formats/text_writer.hpp"

namespace loopbench {
namespace {

void write_pose(TextWriter& out, const PoseGraph& graph, const Pose& pose) {
  const Vector3& t = pose.translation;
  const Rotation& q = pose.rotation;
  out.number(t.x()).number(t.y());
  if (graph.planar) {
    out.number(std::remainder(2.0 * std::atan2(q.z(), q.w()), 2.0 * M_PI));
    return;
  }
  out.number(t.z()).number(q.x()).number(q.y()).number(q.z()).number(q.w());
}

template <class Matrix>
void write_upper(TextWriter& out, const Matrix& information) {
  for (int i = 0; i < information.rows(); ++i) {
    for (int j = i; j < information.cols(); ++j) out.number(information(i, j));
  }
}

const char* suffix(const PoseGraph& graph) {
  if (graph.planar) return "SE2";
  return graph.similarity ? "RST3:QUAT" : "SE3:QUAT";
}

}  // namespace

void write_g2o(const std::filesystem::path& file, const PoseGraph& graph) {
  TextWriter out;
  const std::string vertex = std::string("VERTEX_") + suffix(graph);
  const std::string edge = std::string("EDGE_") + suffix(graph);
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    out.word(vertex).integer(graph.ids[i]);
    write_pose(out, graph, graph.vertices[i]);
    if (graph.similarity) out.number(1.0);
    out.end_line();
  }
  for (const Edge& e : graph.edges) {
    out.word(edge).integer(graph.ids[e.from]).integer(graph.ids[e.to]);
    write_pose(out, graph, e.from_from_to);
    if (graph.similarity) out.number(1.0 / e.scale);
    if (graph.planar) {
      write_upper(out, planar_block(e.information));
    } else {
      write_upper(out, to_half_angles(e.information));
    }
    out.end_line();
  }
  out.save(file);
}

}  // namespace loopbench
