#include "datasets/formats/g2o_lines.hpp"

#include <array>
#include <string>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/core/params.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/g2o_information.hpp"

namespace loopbench {
namespace {

constexpr std::array kPoseTags{
    PoseTag{"VERTEX_SE2", PoseLayout::se2, "5: VERTEX_SE2 id x y yaw"},
    PoseTag{"EDGE_SE2", PoseLayout::se2, "12: EDGE_SE2 i j x y yaw and 6 of information"},
    PoseTag{"VERTEX_SE3:QUAT", PoseLayout::quaternion, "9: VERTEX_SE3:QUAT id x y z qx qy qz qw"},
    PoseTag{"EDGE_SE3:QUAT",
            PoseLayout::quaternion,
            "31: EDGE_SE3:QUAT i j x y z qx qy qz qw and 21 of information"},
    PoseTag{"VERTEX_RST3:QUAT",
            PoseLayout::quaternion_and_scale,
            "10: VERTEX_RST3:QUAT id x y z qx qy qz qw scale"},
    PoseTag{"EDGE_RST3:QUAT",
            PoseLayout::quaternion_and_scale,
            "32 or 39: EDGE_RST3:QUAT i j x y z qx qy qz qw scale and 21 or 28 of information"},
    PoseTag{"VERTEX2", PoseLayout::se2, "5: VERTEX2 id x y yaw"},
    PoseTag{"EDGE2", PoseLayout::se2, "12: EDGE2 i j x y yaw and 6 of information"},
    PoseTag{"VERTEX3", PoseLayout::euler, "8: VERTEX3 id x y z roll pitch yaw"},
    PoseTag{"EDGE3", PoseLayout::euler, "30: EDGE3 i j x y z roll pitch yaw and 21 of information"},
};

/// Throws InputError for lines of switchable constraints.
void reject_switch(const TextFile& file, const Line& line, std::string_view word) {
  if (word.find("SWITCH") == std::string_view::npos) return;
  throw file.error(
      line.number,
      "found " + std::string(word) +
          ", a switchable constraint: expected EDGE_SE2 or EDGE_SE3:QUAT lines without "
          "switches, which the methods pose_graph_dcs and pose_graph_gnc_tls weight "
          "themselves");
}

/// Parser for one line. Throws InputError with the columns required by the tag if one is missing.
class Record {
 public:
  Record(const TextFile& file, const Line& line, const PoseTag& tag, const InformationRules& rules)
      : file_(file), line_(line), tag_(tag), rules_(rules), columns_(file, line) {
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

  /// Parses position and rotation, and `scale` if the tag has one.
  Pose pose(double& scale) {
    Pose out;
    out.translation.x() = number("x");
    out.translation.y() = number("y");
    if (tag_.pose == PoseLayout::se2) {
      out.rotation = exp_so3({0.0, 0.0, number("yaw")});
      return out;
    }
    out.translation.z() = number("z");
    if (tag_.pose == PoseLayout::euler) {
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
    out.rotation = normalized_rotation(file_, line_.number, {w, x, y, z});
    if (tag_.pose == PoseLayout::quaternion_and_scale) {
      scale = number("scale");
      if (!(scale > 0.0)) {
        throw file_.error(line_.number, "scale is " + to_text(scale) + ", expected scale > 0");
      }
      if (!std::isfinite(1.0 / scale)) {
        throw file_.error(line_.number,
                          "scale is " + to_text(scale) + ", too small to be inverted");
      }
    }
    return out;
  }

  /// Parses the rest of the line as information of a twist.
  Matrix6 information() {
    switch (tag_.pose) {
      case PoseLayout::se2:
        return lift_planar(tag_.word == "EDGE2" ? definite<3>(toro_planar()) : upper<3>());
      case PoseLayout::euler:
        return upper<6>();
      case PoseLayout::quaternion:
        return of_quaternion(upper<6>());
      case PoseLayout::quaternion_and_scale:
        break;
    }
    if (count_columns(file_, line_) <= 32) return of_quaternion(upper<6>());
    const auto all = upper<7>();
    scale_information_ = all(6, 6);
    is_scale_correlated_ = !all.topRightCorner<6, 1>().isZero(0.0);
    return of_quaternion(all.topLeftCorner<6, 6>());
  }

  /// Of the logarithm of the scale, after information(); 0: the line has none.
  double scale_information() const { return scale_information_; }
  bool is_scale_correlated() const { return is_scale_correlated_; }

  /// Whether the parsed information was not positive definite.
  bool is_altered() const { return is_altered_; }

 private:
  Matrix6 of_quaternion(const Matrix6& written) const {
    return rules_.rotation == RotationInformation::half_angles ? from_half_angles(written)
                                                               : written;
  }

  void need_column() const {
    if (done()) throw wrong_columns(file_, line_, Format::g2o, tag_.columns);
  }

  /// Parses an upper triangle row by row. Throws InputError if it cannot be made positive definite.
  template <int N>
  Eigen::Matrix<double, N, N> upper() {
    Eigen::Matrix<double, N, N> out;
    for (int i = 0; i < N; ++i) {
      for (int j = i; j < N; ++j) out(i, j) = out(j, i) = number("information");
    }
    end();
    return definite<N>(out);
  }

  /// Parses TORO's order of a planar information: xx xy yy, yaw yaw, x yaw, y yaw. Throws
  /// InputError if only the order row by row is positive definite, as iSAM writes square roots.
  Matrix3 toro_planar() {
    std::array<double, 6> given{};
    for (double& each : given) each = number("information");
    end();
    const auto& [a, b, c, d, e, f] = given;
    const Matrix3 out{{a, b, e}, {b, c, f}, {e, f, d}};
    const Matrix3 by_rows{{a, b, c}, {b, d, e}, {c, e, f}};
    const bool is_any = rules_.indefinite == IndefiniteInformation::project;
    if (is_any || is_positive_definite(out) || !is_positive_definite(by_rows)) return out;
    throw file_.error(line_.number,
                      "information is positive definite row by row, but not in the order of TORO, "
                      "xx xy yy, yaw yaw, x yaw, y yaw: expected tag EDGE_SE2 for rows (iSAM "
                      "writes square roots of information with tag EDGE2)");
  }

  /// Throws InputError if the information cannot be made positive definite.
  template <int N>
  Eigen::Matrix<double, N, N> definite(const Eigen::Matrix<double, N, N>& out) {
    if (is_positive_definite(out)) return out;
    if constexpr (N < 7) {
      is_altered_ = true;
      if (const auto made = made_definite<N>(out, rules_.indefinite)) return *made;
    }
    const bool is_rejected = rules_.indefinite == IndefiniteInformation::reject;
    throw file_.error(line_.number,
                      is_rejected ? "information is not positive definite (option indefinite: "
                                    "repair, project)"
                                  : "information is not positive definite and cannot be altered "
                                    "as the option `indefinite` states");
  }

  const TextFile& file_;
  const Line& line_;
  const PoseTag& tag_;
  InformationRules rules_;
  bool is_altered_ = false;
  double scale_information_ = 0.0;
  bool is_scale_correlated_ = false;
  Columns columns_;
};

}  // namespace

const PoseTag& find_pose_tag(const TextFile& file, const Line& line, std::string_view word) {
  for (const PoseTag& tag : kPoseTags) {
    if (tag.word == word) return tag;
  }
  reject_switch(file, line, word);
  std::string known = "FIX";
  for (const PoseTag& tag : kPoseTags) known.append(", ").append(tag.word);
  for (const PriorTag& tag : kPriorTags) known.append(", ").append(tag.word);
  std::string what =
      "unknown tag '" + std::string(word.substr(0, 40)) + "', expected one of " + known;
  const auto format = guess(file, line);
  if (format && *format != Format::g2o) what += " (looks like " + to_text(*format) + ")";
  throw file.error(line.number, what);
}

VertexRecord read_vertex(const TextFile& file, const Line& line, const PoseTag& tag) {
  Record record(file, line, tag, {});
  VertexRecord out;
  out.id = record.id("id");
  double unused_scale = 1.0;
  out.world_from_body = record.pose(unused_scale);
  record.end();
  out.line = line.number;
  return out;
}

void read_edge(const TextFile& file,
               const Line& line,
               const PoseTag& tag,
               const InformationRules& rules,
               Records& out) {
  Record record(file, line, tag, rules);
  const std::int64_t from = record.id("i");
  const EdgeEnds ends{from, record.id("j"), line.number};
  double inverse_scale = 1.0;
  Edge& edge = out.edges.emplace_back();
  edge.from_from_to = record.pose(inverse_scale);
  edge.scale = 1.0 / inverse_scale;
  edge.information = record.information();
  out.altered += record.is_altered() ? 1 : 0;
  edge.scale_information = record.scale_information();
  out.scale_correlations += record.is_scale_correlated() ? 1 : 0;
  if (ends.from == ends.to) {
    throw file.error(line.number, "edge connects vertex " + id_text(ends.from) + " to itself");
  }
  out.ends.push_back(ends);
}

OffsetRecord read_offset(const TextFile& file, const Line& line) {
  Columns columns(file, line);
  columns.word();
  OffsetRecord out;
  out.id = columns.integer("id");
  for (double& x : out.point) x = columns.number("position");
  return out;
}

}  // namespace loopbench
