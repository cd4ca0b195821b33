#include "datasets/formats/columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/parts.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/stamps.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

constexpr std::array kTumColumns{"stamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};

InputError wrong_row(const TextFile& file, const Line& line, bool positions, std::size_t width) {
  if (positions && width == 4) {
    return wrong_columns(file, line, Format::tum, "4 as in the first row: stamp x y z");
  }
  if (count_columns(file, line) == 4 && !line.unterminated) {
    return file.error(line.number,
                      std::string("has 4 columns (stamp x y z?): ") +
                          (positions ? "the first row has a rotation"
                                     : "positions without rotation are accepted only as a "
                                       "reference, and by eval, doctor and traj") +
                          ", expected 8: stamp tx ty tz qx qy qz qw");
  }
  return wrong_columns(file, line, Format::tum, "8: stamp tx ty tz qx qy qz qw");
}

Trajectory read_tum_part(TextFile& file, const ReadOptions& options, bool small_nanoseconds) {
  Trajectory out;
  const Line first = first_line(file);
  const bool positions = options.positions;
  const std::size_t width = positions && count_columns(file, first) == 4 ? 4 : kTumColumns.size();
  out.reserve(file.estimated_lines(first));
  StampOrder order(file, options.repeats);
  std::array<double, kTumColumns.size()> v{};
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    for (std::size_t i = 0; i < width; ++i) {
      if (columns.done()) throw wrong_row(file, line, positions, width);
      v[i] = columns.number(kTumColumns[i]);
    }
    if (!columns.done()) throw wrong_row(file, line, positions, width);
    if (is_in_nanoseconds(v[0], small_nanoseconds)) {
      v[0] = read_stamp(Columns(file, line).peek(), v[0], -9).seconds;
    }
    const Rotation rotation = rotation_of_row(file, line, {v[7], v[4], v[5], v[6]}, out, positions);
    order.put(v[0], line.number, {rotation, {v[1], v[2], v[3]}}, out);
  }
  return out;
}

}  // namespace

Trajectory read_tum(TextFile& file, const ReadOptions& options) {
  const bool small_nanoseconds = has_small_nanoseconds(file);
  return joined(read_parallel(
      file,
      [&](TextFile& part) { return read_tum_part(part, options, small_nanoseconds); },
      follows));
}

}  // namespace loopbench
