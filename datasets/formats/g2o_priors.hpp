/// Lines of g2o files that measure the position of one vertex.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/text_file.hpp"
#include "datasets/core/anchor.hpp"
#include "datasets/formats/detect_format.hpp"

namespace loopbench {

/// Line that measures the position of a vertex.
struct PriorRecord {
  std::int64_t id = 0;
  Anchor anchor;                               ///< keyframe not set, nor the point of a parameter
  std::optional<std::int64_t> parameter = {};  ///< id of the PARAMS_SE3OFFSET line that it names
  std::size_t line = 0;
};

struct PriorTag {
  std::string_view word;
  int dimension;        ///< of the position
  bool has_rotation;    ///< yaw or a quaternion, in whose axes the information is
  std::size_t fewest;   ///< columns
  const char* columns;  ///< for error messages
};

inline constexpr std::array kPriorTags{
    PriorTag{"EDGE_SE3_PRIOR",
             3,
             true,
             30,
             "30 or 31: EDGE_SE3_PRIOR id [parameter] x y z qx qy qz qw and 21 of information"},
    PriorTag{"EDGE_PRIOR_SE2", 2, true, 11, "11: EDGE_PRIOR_SE2 id x y yaw and 6 of information"},
    PriorTag{"EDGE_PRIOR_SE2_XY", 2, false, 7, "7: EDGE_PRIOR_SE2_XY id x y and 3 of information"},
    PriorTag{"EDGE_SE2_XYPRIOR", 2, false, 7, "7: EDGE_SE2_XYPRIOR id x y and 3 of information"},
    PriorTag{"EDGE_POINTXYZ", 3, false, 11, "11: EDGE_POINTXYZ id x y z and 6 of information"},
    PriorTag{
        "EDGE_SE3_PRIORXYZ", 3, false, 11, "11: EDGE_SE3_PRIORXYZ id x y z and 6 of information"},
};

/// Lines of hdl_graph_slam that measure no position of three coordinates, and its planes: they are
/// counted and not used.
inline bool is_unused_tag(std::string_view word) {
  constexpr std::array<std::string_view, 3> kUnused{
      "EDGE_SE3_PRIORXY", "EDGE_SE3_PRIORVEC", "EDGE_SE3_PRIORQUAT"};
  return std::ranges::find(kUnused, word) != kUnused.end() || word.starts_with("VERTEX_PLANE") ||
         word.starts_with("EDGE_SE3_PLANE") || word.starts_with("EDGE_PLANE");
}

/// Reads a line whose tag is `word`; nullopt if that is no prior. Throws InputError for a wrong
/// number of columns and information of the position that is not positive definite. O(1).
inline std::optional<PriorRecord> read_prior(const TextFile& file,
                                             const Line& line,
                                             std::string_view word) {
  const auto* const found = std::ranges::find(kPriorTags, word, &PriorTag::word);
  if (found == kPriorTags.end()) return std::nullopt;
  const PriorTag& tag = *found;
  const std::size_t count = count_columns(file, line);
  const bool is_spatial = tag.dimension == 3;
  const bool has_parameter = tag.has_rotation && is_spatial && count == tag.fewest + 1;
  if (count != tag.fewest && !has_parameter) {
    throw wrong_columns(file, line, Format::g2o, tag.columns);
  }
  Columns columns(file, line);
  columns.word();
  PriorRecord out;
  out.line = line.number;
  out.id = columns.integer("id");
  if (has_parameter) out.parameter = columns.integer("parameter");
  for (int i = 0; i < tag.dimension; ++i) out.anchor.position[i] = columns.number("position");
  Rotation rotation = Rotation::Identity();
  if (tag.has_rotation && is_spatial) {
    for (double& x : rotation.coeffs()) x = columns.number("quaternion");
    rotation = normalized_rotation(file, line.number, rotation);
  } else if (tag.has_rotation) {
    rotation = exp_so3({0.0, 0.0, columns.number("yaw")});
  }
  const int rotations = is_spatial ? 3 : 1;
  const int size = tag.dimension + (tag.has_rotation ? rotations : 0);
  Eigen::MatrixXd information(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = i; j < size; ++j) {
      information(i, j) = information(j, i) = columns.number("information");
    }
  }
  // Exports of GNSS have no information about the rotation.
  if (information.llt().info() != Eigen::Success) {
    information = information.topLeftCorner(tag.dimension, tag.dimension).eval();
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success) {
    throw file.error(line.number, "information of the position is not positive definite");
  }
  const Eigen::MatrixXd all =
      factor.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  Matrix3 covariance = Matrix3::Identity() * all(0, 0);  // z of planar ones has no effect
  covariance.topLeftCorner(tag.dimension, tag.dimension) =
      all.topLeftCorner(tag.dimension, tag.dimension);
  const Matrix3 R = rotation.toRotationMatrix();
  covariance = R * covariance * R.transpose();
  out.anchor.covariance = 0.5 * (covariance + covariance.transpose());
  return out;
}

}  // namespace loopbench
