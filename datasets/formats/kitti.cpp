#include <fmt/format.h>

#include <Eigen/LU>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/parts.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

constexpr std::array kKittiColumns{
    "r11", "r12", "r13", "tx", "r21", "r22", "r23", "ty", "r31", "r32", "r33", "tz"};
using Row = std::array<double, kKittiColumns.size()>;

PoseMatrix matrix_of(const TextFile& file, std::size_t line, const Row& v) {
  constexpr double kTolerance = 1e-3;
  PoseMatrix out;
  out.matrix() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  const Matrix3 R = out.linear();
  const double deviation = (R * R.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance)) {
    throw file.error(
        line,
        fmt::format("rotation deviates from orthonormal by {:.3g}, expected at most 0.001",
                    deviation));
  }
  if (R.determinant() < 0.0) {
    throw file.error(line, "determinant is -1 (a reflection), expected a rotation");
  }
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
    out.push_back({static_cast<double>(out.size() + file.repaired.invalid), pose_of(m)});
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

}  // namespace

void set_stamps(const TextFile& file, const ReadOptions& options, Trajectory& poses) {
  if (!options.times) {
    for (StampedPose& pose : poses) pose.stamp *= options.period;
    return;
  }
  const std::vector<double> times = read_times(*options.times, options);
  const std::size_t rows = poses.size() + file.repaired.invalid;
  const auto last = static_cast<std::size_t>(poses.back().stamp);
  const bool by_rows = file.repaired.clock == Clock::rows;
  if (by_rows ? times.size() != rows : times.size() <= last) {
    throw file.error(
        0,
        fmt::format("has {}, but {} has {} times, expected {}",
                    by_rows ? fmt::format("{} poses", rows) : fmt::format("frame {}", last),
                    options.times->string(),
                    times.size(),
                    by_rows ? "equal numbers" : "one for each frame from 0 on"));
  }
  for (StampedPose& pose : poses) pose.stamp = times[static_cast<std::size_t>(pose.stamp)];
  file.repaired.clock = Clock::stamps;
}

std::vector<double> read_times(const std::filesystem::path& path, const ReadOptions& options) {
  TextFile file(path);
  first_line(file);
  ReadOptions own{.sort = options.sort, .stamp_unit = options.stamp_unit};
  const int exponent = stamp_exponent(file, 0, own);
  std::vector<double> out;
  StampOrder order(file, own, exponent);
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    const std::string_view word = columns.peek();
    out.push_back(next_stamp(columns, exponent).seconds);
    if (!columns.done()) throw wrong_columns(file, line, Format::automatic, "1: a time in seconds");
    order.accepts(out.back(), word, line.number);
  }
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
  if (!out.empty()) set_stamps(file, options, out);
  return out;
}

std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& path) {
  TextFile file(path);
  std::vector<PoseMatrix> out;
  each_row(file, {}, 0, [&](double, std::string_view, const PoseMatrix& matrix, std::size_t) {
    out.push_back(matrix);
  });
  return out;
}

}  // namespace loopbench
