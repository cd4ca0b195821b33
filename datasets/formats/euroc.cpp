#include "datasets/formats/columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

constexpr std::array kEurocColumns{"px", "py", "pz", "qw", "qx", "qy", "qz"};

}  // namespace

Trajectory read_euroc(TextFile& file, const ReadOptions& options) {
  Trajectory out;
  const Line first = first_line(file);
  const std::size_t width = count_columns(file, first);
  out.reserve(file.estimated_lines(first));
  StampOrder order(file, options.repeats);
  std::array<double, kEurocColumns.size()> v{};
  for (Line line; file.next(line);) {
    const std::size_t count = count_columns(file, line);
    if (count < 1 + kEurocColumns.size() && !(options.positions && count == 4)) {
      throw wrong_columns(
          file, line, Format::euroc, "8 or more: nanoseconds, px py pz, qw qx qy qz");
    }
    if (count != width) {
      throw wrong_columns(file,
                          line,
                          Format::euroc,
                          std::to_string(width) + " as on line " + std::to_string(first.number));
    }
    Columns columns(file, line);
    const double stamp = seconds_of(columns.integer("nanoseconds"));
    for (std::size_t i = 0; i < std::min(count - 1, v.size()); ++i) {
      v[i] = columns.number(kEurocColumns[i]);
    }
    const Rotation rotation =
        rotation_of_row(file, line, {v[3], v[4], v[5], v[6]}, out, options.positions);
    order.put(stamp, line.number, {rotation, {v[0], v[1], v[2]}}, out);
  }
  return out;
}

}  // namespace loopbench
