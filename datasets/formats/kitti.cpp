#include <fmt/format.h>

#include <Eigen/LU>

#include "datasets/formats/columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/parts.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/stamps.hpp"
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

bool has_stamps(const TextFile& file, const Line& line) {
  return count_columns(file, line) == kKittiColumns.size() + 1;
}

/// Calls visit(stamp, matrix, line) for every line, in order; without stamps, stamps are zero.
template <class Visit>
void each_row(TextFile& file, Visit visit) {
  Row v;
  Line line;
  if (!file.next(line)) return;
  const bool is_stamped = has_stamps(file, line);
  const char* const expected =
      is_stamped ? "13: a stamp and a 3 x 4 pose row by row" : "12: a 3 x 4 pose row by row";
  do {
    Columns columns(file, line);
    double stamp = 0.0;
    if (is_stamped) {
      stamp = next_stamp(columns).seconds;
    }
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (columns.done()) throw wrong_columns(file, line, Format::kitti, expected);
      v[i] = columns.number(kKittiColumns[i]);
    }
    if (!columns.done()) throw wrong_columns(file, line, Format::kitti, expected);
    visit(stamp, matrix_of(file, line.number, v), line.number);
  } while (file.next(line));
}

/// Reads the poses of a part of a file; stamps are not set.
Trajectory read_kitti_part(TextFile& file) {
  Trajectory out;
  out.reserve(file.estimated_lines(first_line(file)));
  each_row(file, [&](double, const PoseMatrix& m, std::size_t) {
    out.push_back({0.0, pose_of(m)});
  });
  return out;
}

/// Reads a file whose rows begin with a stamp.
Trajectory read_stamped(TextFile& file, const ReadOptions& options) {
  Trajectory out;
  StampOrder order(file, options.repeats);
  each_row(file, [&](double stamp, const PoseMatrix& m, std::size_t line) {
    order.put(stamp, line, pose_of(m), out);
  });
  return out;
}

}  // namespace

std::vector<double> read_times(const std::filesystem::path& path) {
  TextFile file(path);
  first_line(file);
  std::vector<double> out;
  StampOrder order(file, Repeats::refuse, "");
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    out.push_back(columns.number("time"));
    if (!columns.done()) throw wrong_columns(file, line, Format::automatic, "1: a time in seconds");
    order.accepts(out.back(), line.number);
  }
  return out;
}

Trajectory read_kitti(TextFile& file, const ReadOptions& options) {
  if (has_stamps(file, first_line(file))) {
    if (options.times) throw file.error(0, "has stamps: found --times, expected none");
    return read_stamped(file, options);
  }
  Trajectory out = joined(read_parallel(
      file, read_kitti_part, [](const Trajectory&, const Trajectory&) { return true; }));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].stamp = static_cast<double>(i) * options.period;
  }
  if (!options.times) return out;
  const std::vector<double> times = read_times(*options.times);
  if (times.size() != out.size()) {
    throw file.error(0,
                     "has " + std::to_string(out.size()) + " poses, but " +
                         options.times->string() + " has " + std::to_string(times.size()) +
                         " times, expected equal numbers");
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].stamp = times[i];
  return out;
}

std::vector<PoseMatrix> read_kitti_matrices(const std::filesystem::path& path) {
  TextFile file(path);
  first_line(file);
  std::vector<PoseMatrix> out;
  each_row(file, [&](double, const PoseMatrix& matrix, std::size_t) { out.push_back(matrix); });
  return out;
}

}  // namespace loopbench
