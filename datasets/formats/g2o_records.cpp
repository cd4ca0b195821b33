#include "datasets/formats/g2o_records.hpp"

#include <array>
#include <string>

#include "datasets/core/params.hpp"
#include "datasets/formats/columns.hpp"
#include "datasets/formats/g2o_information.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/recognise.hpp"

namespace loopbench {
namespace {

enum class Pose3 { se2, quaternion, euler, quaternion_and_scale };

struct Tag {
  const char* word;
  bool is_edge;
  GraphKind kind;
  Pose3 pose;
  const char* columns;  ///< for messages
};

constexpr std::array kTags{
    Tag{"VERTEX_SE2", false, GraphKind::planar, Pose3::se2, "5: VERTEX_SE2 id x y yaw"},
    Tag{"EDGE_SE2",
        true,
        GraphKind::planar,
        Pose3::se2,
        "12: EDGE_SE2 i j x y yaw and 6 of information"},
    Tag{"VERTEX_SE3:QUAT",
        false,
        GraphKind::spatial,
        Pose3::quaternion,
        "9: VERTEX_SE3:QUAT id x y z qx qy qz qw"},
    Tag{"EDGE_SE3:QUAT",
        true,
        GraphKind::spatial,
        Pose3::quaternion,
        "31: EDGE_SE3:QUAT i j x y z qx qy qz qw and 21 of information"},
    Tag{"VERTEX_RST3:QUAT",
        false,
        GraphKind::similarity,
        Pose3::quaternion_and_scale,
        "10: VERTEX_RST3:QUAT id x y z qx qy qz qw scale"},
    Tag{"EDGE_RST3:QUAT",
        true,
        GraphKind::similarity,
        Pose3::quaternion_and_scale,
        "32 or 39: EDGE_RST3:QUAT i j x y z qx qy qz qw scale and 21 or 28 of information"},
    Tag{"VERTEX3", false, GraphKind::spatial, Pose3::euler, "8: VERTEX3 id x y z roll pitch yaw"},
    Tag{"EDGE3",
        true,
        GraphKind::spatial,
        Pose3::euler,
        "30: EDGE3 i j x y z roll pitch yaw and 21 of information"},
};

const Tag& find_tag(const TextFile& file, const Line& line, std::string_view word) {
  for (const Tag& tag : kTags) {
    if (tag.word == word) return tag;
  }
  std::string known;
  for (const Tag& tag : kTags) known += std::string(known.empty() ? "" : ", ") + tag.word;
  const auto format = guess(file, line);
  throw file.error(line.number,
                   "unknown tag '" + std::string(word.substr(0, 40)) +
                       "', expected FIX or one of " + known +
                       (format && *format != Format::g2o ? " (looks like " + to_text(*format) + ")"
                                                         : std::string()));
}

/// One line being read: every missing column is a refusal that says what the tag needs.
class Record {
 public:
  Record(const TextFile& file, const Line& line, const Tag& tag)
      : file_(file), line_(line), tag_(tag), columns_(file, line) {
    columns_.word();
  }

  std::int64_t id(const char* what) {
    need_column();
    return columns_.integer(what);
  }

  double number(const char* what) {
    need_column();
    return columns_.number(what);
  }

  bool done() const { return columns_.done(); }

  void end() const {
    if (!done()) throw wrong_columns(file_, line_, Format::g2o, tag_.columns);
  }

  /// Position and attitude, and the scale where there is one.
  Pose pose(double& scale) {
    Pose out;
    out.translation.x() = number("x");
    out.translation.y() = number("y");
    if (tag_.pose == Pose3::se2) {
      out.rotation = exp_so3({0.0, 0.0, number("yaw")});
      return out;
    }
    out.translation.z() = number("z");
    if (tag_.pose == Pose3::euler) {
      const double roll = number("roll");
      const double pitch = number("pitch");
      const double yaw = number("yaw");
      out.rotation =
          exp_so3({0.0, 0.0, yaw}) * exp_so3({0.0, pitch, 0.0}) * exp_so3({roll, 0.0, 0.0});
      return out;
    }
    const double x = number("qx");
    const double y = number("qy");
    const double z = number("qz");
    const double w = number("qw");
    out.rotation = unit_rotation(file_, line_.number, {w, x, y, z});
    if (tag_.pose == Pose3::quaternion_and_scale) {
      scale = number("scale");
      if (!(scale > 0.0)) {
        throw file_.error(line_.number, "scale is " + to_text(scale) + ", expected scale > 0");
      }
    }
    return out;
  }

  /// The rest of the line, as information of a twist.
  Matrix6 information() {
    switch (tag_.pose) {
      case Pose3::se2:
        return lift_planar(upper<3>());
      case Pose3::euler:
        return upper<6>();
      case Pose3::quaternion:
        return from_half_angles(upper<6>());
      case Pose3::quaternion_and_scale:
        break;
    }
    const bool has_scale = count_columns(file_, line_) > 32;
    return from_half_angles(has_scale ? Matrix6(upper<7>().topLeftCorner<6, 6>()) : upper<6>());
  }

 private:
  void need_column() const {
    if (done()) throw wrong_columns(file_, line_, Format::g2o, tag_.columns);
  }

  /// The upper triangle row by row, checked.
  template <int N>
  Eigen::Matrix<double, N, N> upper() {
    Eigen::Matrix<double, N, N> out;
    for (int i = 0; i < N; ++i) {
      for (int j = i; j < N; ++j) out(i, j) = out(j, i) = number("information");
    }
    end();
    if (Eigen::LLT<Eigen::Matrix<double, N, N>>(out).info() != Eigen::Success) {
      throw file_.error(line_.number, "information is not positive definite");
    }
    return out;
  }

  const TextFile& file_;
  const Line& line_;
  const Tag& tag_;
  Columns columns_;
};

VertexRecord read_vertex(Record record, const Line& line) {
  VertexRecord out;
  out.id = record.id("id");
  double scale_is_in_the_pose_already = 1.0;
  out.world_from_body = record.pose(scale_is_in_the_pose_already);
  record.end();
  out.line = line.number;
  return out;
}

EdgeRecord read_edge(const TextFile& file, Record record, const Line& line) {
  EdgeRecord out;
  out.from = record.id("i");
  out.to = record.id("j");
  double from_unit_over_to = 1.0;
  out.edge.from_from_to = record.pose(from_unit_over_to);
  out.edge.scale = 1.0 / from_unit_over_to;
  out.edge.information = record.information();
  out.line = line.number;
  if (out.from == out.to) {
    throw file.error(line.number, "edge joins vertex " + std::to_string(out.from) + " to itself");
  }
  return out;
}

}  // namespace

Records read_records(TextFile& file) {
  first_line(file);
  Records out;
  const Tag* first = nullptr;
  std::size_t first_at = 0;
  for (Line line; file.next(line);) {
    const std::string_view word = Columns(file, line).peek();
    if (word == "FIX") continue;
    const Tag& tag = find_tag(file, line, word);
    if (first == nullptr) {
      first = &tag;
      first_at = line.number;
      out.kind = tag.kind;
    }
    if (tag.kind != out.kind) {
      throw file.error(line.number,
                       std::string(tag.word) + " in a file that began with " + first->word +
                           " on line " + std::to_string(first_at) + ", expected one kind of pose");
    }
    const Record record(file, line, tag);
    if (tag.is_edge) {
      out.edges.push_back(read_edge(file, record, line));
    } else {
      out.vertices.push_back(read_vertex(record, line));
    }
  }
  if (first == nullptr) throw file.error(0, "holds neither vertices nor edges");
  return out;
}

}  // namespace loopbench
