#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/known_layouts.hpp"
#include "datasets/formats/written_rows.hpp"

namespace loopbench {
namespace {

constexpr std::array kEurocColumns{"px", "py", "pz", "qw", "qx", "qy", "qz"};

/// Whether the stamps of a file are whole numbers that cannot be seconds.
bool has_whole_ticks(const TextFile& file, std::string_view stamp) {
  const bool is_whole = stamp.find_first_not_of("0123456789") == stamp.npos;
  return is_whole && fitting_units(file, 0).units.front() != StampUnit::s;
}

/// Rows of ORB-SLAM3 have whole nanoseconds, too, but no commas and the quaternion of TUM.
bool is_euroc(const TextFile& file, const Line& line) {
  const std::string_view stamp = Columns(file, line).word();
  const std::size_t count = count_columns(file, line);
  if (is_nanoseconds(stamp) && count == 4) return true;
  if (count < 8 || (count == 8 && line.text.find(',') == line.text.npos)) return false;
  return is_nanoseconds(stamp) || (count != 12 && has_whole_ticks(file, stamp));
}

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

/// Throws InputError for stamps that do not fit, or that are no longer different.
std::vector<std::int64_t> rounded_nanoseconds(const TrajectoryFile& file, const std::string& name) {
  constexpr double kMost = 9.2e9;  // [s]; int64_t holds 9.22e9
  if (!file.nanoseconds.empty()) return file.nanoseconds;
  std::vector<std::int64_t> out;
  out.reserve(file.poses.size());
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    const double stamp = file.poses[i].stamp;
    const double seconds = std::floor(stamp);
    if (!(std::abs(stamp) < kMost)) {
      throw InputError(fmt::format(
          "{}: nanoseconds of stamp {} do not fit in 64 bits, expected seconds below {}",
          name,
          stamp,
          kMost));
    }
    const auto whole = static_cast<std::int64_t>(seconds) * 1'000'000'000;
    out.push_back(whole + std::llround((stamp - seconds) * 1e9));
    if (i > 0 && out[i] == out[i - 1] && stamp != file.poses[i - 1].stamp) {
      throw InputError(fmt::format(
          "{}: stamps {} and {} are one nanosecond", name, file.poses[i - 1].stamp, stamp));
    }
  }
  return out;
}

TextWriter euroc_text(const TrajectoryFile& file, const std::string& name) {
  const std::vector<std::int64_t> stamps = rounded_nanoseconds(file, name);
  TextWriter out(',');
  out.comment("timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []");
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    const Pose& pose = file.poses[i].world_from_body;
    out.integer(stamps[i]);
    write_position(out, pose);
    const Rotation& q = pose.rotation;
    out.number(q.w()).number(q.x()).number(q.y()).number(q.z());
    out.end_line();
  }
  return out;
}

}  // namespace

FormatEntry euroc_format() {
  return {.format = Format::euroc, .guess = is_euroc, .read = read_euroc, .write = euroc_text};
}

}  // namespace loopbench
