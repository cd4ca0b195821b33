#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"
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
  const int exponent = stamp_exponent(file, 0, options);
  StampOrder order(file, options, exponent);
  std::array<double, kEurocColumns.size()> v{};
  for_each_row(file, options, [&](const Line& line) {
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
    const std::string_view word = columns.peek();
    const auto whole = static_cast<double>(columns.integer("nanoseconds"));
    const double stamp = read_stamp(word, whole, exponent).seconds;
    for (std::size_t i = 0; i < std::min(count - 1, v.size()); ++i) {
      v[i] = columns.number(kEurocColumns[i]);
    }
    const Rotation rotation = rotation_of_row(file, line, {v[3], v[4], v[5], v[6]}, out, options);
    order.put(stamp, word, line.number, {rotation, {v[0], v[1], v[2]}}, out);
  });
  return out;
}

}  // namespace loopbench
