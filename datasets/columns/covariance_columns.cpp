#include "datasets/columns/covariance_columns.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <sstream>
#include <string>

#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/core/covariance.hpp"
#include "datasets/core/params.hpp"

namespace loopbench {
namespace {

using Part = CovarianceColumns::Part;
using Numbers = std::array<double, 36>;

Matrix6 matrix_of(const Numbers& v, Part part, int axes) {
  Matrix6 out = Matrix6::Zero();
  std::size_t k = 0;
  for (int i = 0; i < axes; ++i) {
    const int begin = part == Part::upper ? i : 0;
    const int end = part == Part::lower ? i + 1 : axes;
    for (int j = begin; j < end; ++j) {
      out(i, j) = v[k++];
      if (part != Part::all) out(j, i) = out(i, j);
    }
  }
  return out;
}

Numbers numbers_of(Columns& columns, std::size_t count) {
  Numbers out{};
  for (std::size_t i = 0; i < count; ++i) out[i] = columns.number("covariance");
  return out;
}

/// Position in `words` of the value of a line `#%KEY value`; nothing if the file has no such line.
template <std::size_t N>
std::optional<std::size_t> stated(const TextFile& file,
                                  const std::string& key,
                                  const std::array<const char*, N>& words) {
  for (const auto& [number, text] : file.settings()) {
    std::istringstream in(text);
    std::string name, value, accepted;
    if (!(in >> name >> value) || name != key) continue;
    for (std::size_t i = 0; i < N; ++i) {
      if (value == words[i]) return i;
      if (i > 0) accepted += i + 1 == N ? " or " : ", ";
      accepted += words[i];
    }
    throw file.error(number, "#%" + key + " is '" + value + "', expected " + accepted);
  }
  return std::nullopt;
}

bool is_square_format(const TextFile& file) {
  for (const auto& [number, text] : file.settings()) {
    if (text.starts_with("FORMAT SQUARE")) return true;
  }
  return false;
}

Part part_of(const TextFile& file, const Line& first, std::size_t before, int axes) {
  if (is_square_format(file)) return Part::lower;
  Columns columns(file, first);
  for (std::size_t i = 0; i < before; ++i) columns.word();
  const auto count = static_cast<std::size_t>(axes * (axes + 1) / 2);
  const Numbers v = numbers_of(columns, count);
  const auto fits = [&](Part part) {  // axes without an error say nothing about the part
    const Matrix6 matrix = matrix_of(v, part, axes);
    return is_covariance(matrix, axes == 6) && (matrix.diagonal().head(axes).array() > 0.0).all();
  };
  const bool is_lower = fits(Part::lower);
  if (is_lower && fits(Part::upper)) {
    throw file.error(first.number,
                     "the upper and the lower triangle of a covariance fit the last " +
                         std::to_string(count) + " columns, expected " +
                         std::to_string(axes * axes) +
                         ", or '#%FORMAT SQUARE' above for the lower one");
  }
  return is_lower ? Part::lower : Part::upper;
}

}  // namespace

std::vector<std::string> covariance_names(bool has_rotation) {
  constexpr std::array kAxes{"x", "y", "z", "roll", "pitch", "yaw"};
  const std::size_t axes = has_rotation ? kAxes.size() : 3;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < axes; ++i) {
    for (std::size_t j = i; j < axes; ++j) {
      out.push_back(std::string("cov_") + kAxes[i] + "_" + kAxes[j]);
    }
  }
  return out;
}

void put_covariance(const TextFile& file,
                    const Matrix6& covariance,
                    std::size_t poses,
                    Repeats repeats) {
  std::vector<Matrix6>& all = file.repaired.covariances;
  if (all.size() < poses) {
    all.push_back(covariance);
  } else if (repeats == Repeats::keep_last) {
    all.back() = covariance;
  }
}

bool is_covariance(const Matrix6& matrix, bool has_rotation) {
  std::vector<Eigen::Index> axes;
  for (Eigen::Index i = 0; i < (has_rotation ? 6 : 3); ++i) {
    if (!matrix.row(i).isZero(0.0)) axes.push_back(i);
  }
  return axes.empty() || Eigen::MatrixXd(matrix(axes, axes)).llt().info() == Eigen::Success;
}

std::optional<CovarianceColumns> covariance_columns(const TextFile& file,
                                                    const Line& first,
                                                    std::size_t before) {
  const std::size_t width = count_columns(file, first);
  const std::size_t count = width > before ? width - before : 0;
  const bool is_position = before == 1 && (count == 6 || count == 9);
  if (count != 21 && count != 36 && !is_position) return std::nullopt;
  CovarianceColumns out;
  out.axes = is_position ? 3 : 6;
  if (count != out.count()) out.part = part_of(file, first, before, out.axes);
  stated(file, "ROTATION_PARAM", std::array{"axis_angle"});
  const auto convention =
      stated(file,
             "TANGENT_CONVENTION",
             std::array{"right_perturbation", "left_perturbation", "fixed_axes"});
  const auto order =
      stated(file, "TANGENT_ORDER", std::array{"translation_rotation", "rotation_translation"});
  out.is_stated = convention.has_value();
  out.rotation_first = order.value_or(0) == 1;
  const bool is_fixed = out.part == Part::all || is_position;
  out.convention = is_fixed ? TangentConvention::fixed_axes : TangentConvention::right_perturbation;
  if (convention) out.convention = choices(TangentConvention{})[*convention].second;
  return out;
}

Matrix6 read_covariance(const TextFile& file,
                        const Line& line,
                        Columns& columns,
                        const CovarianceColumns& layout,
                        const Pose& pose) {
  constexpr double kPrintedDigits = 1e-5;
  Matrix6 out = matrix_of(numbers_of(columns, layout.count()), layout.part, layout.axes);
  if (layout.rotation_first) {
    const Matrix6 given = out;
    const Eigen::PermutationMatrix<6> exchanged(
        (Eigen::Matrix<int, 6, 1>() << 3, 4, 5, 0, 1, 2).finished());
    out = exchanged * given * exchanged.transpose();
  }
  const Matrix6 skew = out - out.transpose();
  if (skew.cwiseAbs().maxCoeff() > kPrintedDigits * out.cwiseAbs().maxCoeff()) {
    throw file.error(line.number, "covariance is not symmetric");
  }
  if (skew.any()) out = (0.5 * (out + out.transpose())).eval();
  if (!is_covariance(out, layout.axes == 6))
    throw file.error(line.number, "covariance is not positive definite");
  if (layout.convention == TangentConvention::left_perturbation) {
    return displaced(out, pose.translation);
  }
  if (layout.convention == TangentConvention::fixed_axes) return out;
  if (!has_rotation(pose)) {
    throw file.error(line.number,
                     "has a covariance in the axes of the body, but no rotation, expected "
                     "'#%TANGENT_CONVENTION fixed_axes'");
  }
  return rotated(out, pose.rotation.toRotationMatrix());
}

std::vector<Matrix6> read_covariance_file(const std::filesystem::path& path,
                                          const Trajectory& poses,
                                          bool& assumed_axes) {
  constexpr double kSameStamp = 1e-6;  // [s]
  TextFile file(path);
  file.skip_header();
  const auto layout = covariance_columns(file, first_line(file), 1);
  if (!layout) {
    throw file.error(0, "expected a stamp and 6, 9 (position), 21 or 36 numbers of a covariance");
  }
  const int exponent = stamp_exponent(file, 0, {});
  assumed_axes = layout->axes == 6 && !layout->is_stated;
  std::vector<Matrix6> out;
  for (Line line; file.next(line);) {
    if (count_columns(file, line) != 1 + layout->count()) {
      throw file.error(line.number,
                       "has " + columns_text(count_columns(file, line)) + ", expected " +
                           columns_text(1 + layout->count()) + " as in the first row");
    }
    Columns columns(file, line);
    const double stamp = next_stamp(columns, exponent).seconds;
    const std::size_t i = out.size();
    if (i == poses.size() || !(std::abs(stamp - poses[i].stamp) <= kSameStamp)) {
      throw file.error(line.number,
                       "stamp " + to_text(stamp) + ": expected " +
                           (i == poses.size()
                                ? "no more rows"
                                : to_text(poses[i].stamp) + ", that of pose " + std::to_string(i)));
    }
    out.push_back(read_covariance(file, line, columns, *layout, poses[i].world_from_body));
  }
  if (out.size() == poses.size()) return out;
  throw file.error(0,
                   "has covariances of " + std::to_string(out.size()) + " poses, expected " +
                       std::to_string(poses.size()));
}

}  // namespace loopbench
