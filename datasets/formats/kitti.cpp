#include "datasets/formats/kitti.hpp"

#include <array>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/parts.hpp"
#include "datasets/columns/pose_matrix.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/known_layouts.hpp"

namespace loopbench {
namespace {

constexpr std::array kKittiColumns{
    "r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty", "r31", "r32", "r33", "tz"};
using Row = std::array<double, kKittiColumns.size()>;

PoseMatrix matrix_of(const TextFile& file, std::size_t line, const Row& v) {
  PoseMatrix out;
  out.matrix() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  if (is_missing(out)) {
    throw InvalidRow(file.error(line, "rotation matrix is zero, expected a rotation"));
  }
  const std::string why = normalise_matrix(out, file.repaired);
  if (!why.empty()) throw file.error(line, why);
  return out;
}

/// 12 numbers or 16, the last four of which are 0 0 0 1; one more with a stamp or a frame.
bool is_stamped(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  return count == 13 || count == 17;
}

/// Calls visit(stamp, matrix, line) for every line, in order; without stamps, stamps are zero.
template <class Visit>
void each_row(TextFile& file, const ReadOptions& options, int exponent, Visit visit) {
  Row v;
  const Line first = first_line(file);
  const bool has_stamp = is_stamped(file, first);
  const std::size_t width = count_columns(file, first);
  const bool is_square = width >= 16;
  const std::string expected =
      width < 13 ? "12: a 3 x 4 pose row by row" : std::to_string(width) + " as in the first row";
  for_each_row(file, options, [&](const Line& line) {
    if (count_columns(file, line) != (width < 13 ? 12 : width)) {
      throw wrong_columns(file, line, Format::kitti, expected);
    }
    Columns columns(file, line);
    const std::string_view word = has_stamp ? columns.peek() : std::string_view();
    const double stamp = has_stamp ? next_stamp(columns, exponent).seconds : 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = columns.number(kKittiColumns[i]);
    for (const double last : {0.0, 0.0, 0.0, 1.0}) {
      if (is_square && columns.number("last row") != last) {
        throw file.error(line.number,
                         "the last row of the matrix is not 0 0 0 1 (written by columns?)");
      }
    }
    visit(stamp, word, matrix_of(file, line.number, v), line.number);
  });
}

/// Reads the poses of a part of a file; stamps are the numbers of its rows.
Trajectory read_kitti_part(TextFile& file, const ReadOptions& options) {
  Trajectory out;
  out.reserve(file.estimated_lines(first_line(file)));
  each_row(file, options, 0, [&](double, std::string_view, const PoseMatrix& m, std::size_t) {
    out.push_back({static_cast<double>(file.repaired.rows), pose_of(m)});
  });
  return out;
}

/// Reads a file whose rows begin with a stamp.
Trajectory read_stamped(TextFile& file, const ReadOptions& options, int exponent) {
  Trajectory out;
  StampOrder order(file, options, exponent);
  each_row(file,
           options,
           exponent,
           [&](double stamp, std::string_view word, const PoseMatrix& m, std::size_t line) {
             order.put(stamp, word, line, pose_of(m), out);
           });
  return out;
}

Trajectory read_kitti(TextFile& file, const ReadOptions& options) {
  const Line first = first_line(file);
  const bool has_frames = is_stamped(file, first) && has_frame_numbers(file, 0);
  if (is_stamped(file, first) && !has_frames) {
    return read_stamped(file, options, stamp_exponent(file, 0, options));
  }
  Trajectory out;
  if (has_frames || options.drop_invalid) {
    out = has_frames ? read_stamped(file, options, 0) : read_kitti_part(file, options);
  } else {
    out = joined(read_parallel(
        file,
        [&](TextFile& part) { return read_kitti_part(part, options); },
        [](const Trajectory&, const Trajectory&) { return true; }));
    for (std::size_t i = 0; i < out.size(); ++i) out[i].stamp = static_cast<double>(i);
  }
  file.repaired.clock = has_frames ? Clock::ids : Clock::rows;
  return out;
}

/// Whether a line has a 4 x 4 matrix, or a matrix after a stamp, whose first two rows begin with
/// unit vectors or end the matrix with 0 0 0 1.
bool is_other_matrix(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  if (count != 13 && count != 16 && count != 17) return false;
  const std::size_t first = count == 16 ? 0 : 1;
  const bool ends = count >= 16 && square_of_columns(file, line, first + 12, 3) == 0.0 &&
                    square_of_columns(file, line, first + 15, 1) == 1.0;
  return ends || (is_unit_square(square_of_columns(file, line, first, 3)) &&
                  is_unit_square(square_of_columns(file, line, first + 4, 3)));
}

bool is_kitti(const TextFile& file, const Line& line) {
  const std::string_view first = Columns(file, line).word();
  return is_other_matrix(file, line) ||
         (count_columns(file, line) == 12 && stamp_number(first) && !is_nanoseconds(first));
}

bool lacks_stamps(const TextFile& file) {
  TextFile reopened = file.reopened();
  return !is_stamped(file, first_line(reopened)) || has_frame_numbers(file, 0);
}

TextWriter kitti_text(const TrajectoryFile& file, const std::string&) {
  TextWriter out;
  for (const auto& [stamp, pose] : file.poses) {
    const Matrix3 R = pose.rotation.toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out.number(R(i, j));
      out.number(pose.translation[i]);
    }
    out.end_line();
  }
  return out;
}

}  // namespace

std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& path) {
  TextFile file(path);
  std::vector<PoseMatrix> out;
  each_row(file, {}, 0, [&](double, std::string_view, const PoseMatrix& matrix, std::size_t) {
    out.push_back(matrix);
  });
  return out;
}

FormatEntry kitti_format() {
  return {.format = Format::kitti,
          .guess = is_kitti,
          .read = read_kitti,
          .takes_times = lacks_stamps,
          .write = kitti_text};
}

}  // namespace loopbench
