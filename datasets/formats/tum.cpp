#include "datasets/formats/columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/parts.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/stamps.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

constexpr std::array kTumColumns{"stamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};

InputError wrong_row(const TextFile& file, const Line& line) {
  if (count_columns(file, line) == 4 && !line.unterminated) {
    return file.error(line.number,
                      "has 4 columns (stamp x y z?): positions without rotation are not supported, "
                      "expected 8: stamp tx ty tz qx qy qz qw");
  }
  return wrong_columns(file, line, Format::tum, "8: stamp tx ty tz qx qy qz qw");
}

Trajectory read_tum_part(TextFile& file, Repeats repeats, bool small_nanoseconds) {
  Trajectory out;
  out.reserve(file.estimated_lines(first_line(file)));
  StampOrder order(file, repeats);
  std::array<double, kTumColumns.size()> v;
  for (Line line; file.next(line);) {
    Columns columns(file, line);
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (columns.done()) throw wrong_row(file, line);
      v[i] = columns.number(kTumColumns[i]);
    }
    if (!columns.done()) throw wrong_row(file, line);
    if (is_in_nanoseconds(v[0], small_nanoseconds)) {
      v[0] = read_stamp(Columns(file, line).peek(), v[0], -9).seconds;
    }
    const Rotation rotation = normalized_rotation(file, line.number, {v[7], v[4], v[5], v[6]});
    order.put(v[0], line.number, {rotation, {v[1], v[2], v[3]}}, out);
  }
  return out;
}

}  // namespace

Trajectory read_tum(TextFile& file, const ReadOptions& options) {
  const bool small_nanoseconds = has_small_nanoseconds(file);
  return joined(read_parallel(
      file,
      [&](TextFile& part) { return read_tum_part(part, options.repeats, small_nanoseconds); },
      [](const Trajectory& a, const Trajectory& b) { return a.back().stamp < b.front().stamp; }));
}

}  // namespace loopbench
