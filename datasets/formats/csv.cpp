#include "datasets/formats/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "datasets/columns/covariance_columns.hpp"
#include "datasets/columns/parts.hpp"
#include "datasets/columns/pose_rules.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/csv_row.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/nmea.hpp"
#include "datasets/formats/written_rows.hpp"

namespace loopbench {
namespace {

/// Whole seconds and a column of nanoseconds, as in messages of ROS.
ReadStamp split_stamp(const TextFile& file,
                      const Line& line,
                      const CsvColumns& columns,
                      const CsvRow& row) {
  const std::string_view seconds = row[columns.index[0]], nanoseconds = row[*columns.nanoseconds];
  const double whole = csv_number(file, line, columns, row, columns.index[0]);
  const double rest = csv_number(file, line, columns, row, *columns.nanoseconds);
  if (rest < 0.0 || rest >= 1e9 || rest != std::floor(rest) || whole != std::floor(whole)) {
    throw file.error(line.number,
                     "stamp has '" + std::string(seconds) + "' s and '" + std::string(nanoseconds) +
                         "' ns, expected whole seconds and nanoseconds from 0 to 999999999");
  }
  ReadStamp out{whole + 1e-9 * rest, exact_nanoseconds(seconds)};
  std::int64_t sum = 0;
  if (out.exact && __builtin_add_overflow(*out.exact, static_cast<std::int64_t>(rest), &sum)) {
    out.exact.reset();
  } else if (out.exact) {
    out = {seconds_of(sum), sum};
  }
  return out;
}

ReadStamp stamp_of_row(const TextFile& file,
                       const Line& line,
                       const CsvColumns& columns,
                       const CsvRow& row,
                       int exponent) {
  if (columns.nanoseconds) return split_stamp(file, line, columns, row);
  const double number = csv_number(file, line, columns, row, columns.index[0]);
  return read_stamp(stamp_word(row[columns.index[0]]), number, exponent);
}

/// False for a NavSatFix without a position, whose coordinates need not be numbers.
bool has_fix(const TextFile& file, const Line& line, const CsvColumns& columns, const CsvRow& row) {
  if (!columns.fix || csv_number(file, line, columns, row, *columns.fix) >= 0.0) return true;
  ++file.repaired.without_fix;
  return false;
}

Trajectory read_csv_part(TextFile& file,
                         const CsvColumns& columns,
                         int exponent,
                         const ReadOptions& options) {
  Trajectory out;
  StampOrder order(file, options, exponent, columns.index[0]);
  CsvRow row;
  std::array<double, kPoseColumns.size()> v{};
  const bool has_quaternion = columns.has_rotation && columns.angles.empty();
  for_each_row(file, options, [&](const Line& line) {
    split_row(file, line, columns, row);
    if (!has_fix(file, line, columns, row)) return;
    const ReadStamp stamp = stamp_of_row(file, line, columns, row, exponent);
    const std::size_t numbers = has_quaternion ? v.size() : 4;
    for (std::size_t i = 1; i < numbers; ++i) {
      if (i == 3 && columns.lacks_z) continue;
      v[i] = csv_number(file, line, columns, row, columns.index[i]);
    }
    for (std::size_t i = 0; i < columns.per_metre.size(); ++i) v[1 + i] /= columns.per_metre[i];
    const Vector3 position(v[1], v[2], v[3]);
    if (columns.is_geodetic) require_degrees(file, line.number, position);
    Rotation rotation = no_rotation();
    if (has_quaternion) {
      rotation = rotation_of_row(file, line, {v[4], v[5], v[6], v[7]}, out, options);
    } else if (columns.has_rotation) {
      rotation = rotation_of_angles(file, line, columns, row);
    }
    std::optional<Matrix6> covariance;
    if (!columns.covariance.empty()) covariance = covariance_of_row(file, line, columns, row);
    const bool is_split = columns.nanoseconds && stamp.exact;
    const std::string split = is_split ? seconds_text(*stamp.exact) : std::string();
    order.put(stamp.seconds,
              is_split ? split : row[columns.index[0]],
              line.number,
              {rotation, position},
              out);
    if (covariance) put_covariance(file, *covariance, out.size(), options.repeats);
  });
  return out;
}

/// The header that fits a row of `ros2 topic echo --csv`, which has none: whole seconds and
/// nanoseconds, one or two frames, position, quaternion, and what follows. Empty for other rows.
std::string header_of_ros2(const CsvRow& row) {
  constexpr std::size_t kFewest = 10;
  const auto number = [&](std::size_t i) { return stamp_number(row[i]); };
  if (row.size() < kFewest || !number(0) || !number(1) || number(2)) return "";
  const std::size_t first = number(3) ? 3 : 4;
  double square = 0.0;
  for (std::size_t i = first + 3; i < std::min(first + 7, row.size()); ++i) {
    square += std::pow(number(i).value_or(std::nan("")), 2);
  }
  if (!(std::abs(square - 1.0) < 1e-3) || row[0].find('.') != row[0].npos) return "";
  std::string out = "secs,nsecs,frame_id,";
  out += first == 4 ? "child_frame_id,x,y,z,qx,qy,qz,qw" : "x,y,z,qx,qy,qz,qw";
  for (std::size_t i = first + 7; i < row.size(); ++i) out += ",\"\"";
  return out;
}

}  // namespace

std::optional<CsvColumns> csv_columns(const TextFile& file) {
  const bool is_row = !file.header().empty();
  auto out = csv_header(is_row ? file.header() : file.comment()).columns;
  if (is_row) return out;
  TextFile reopened = file.reopened();
  Line line;
  CsvRow row;
  if (reopened.next(line)) split_columns(line.text, row);
  if (!out) out = csv_header(header_of_ros2(row)).columns;
  if (!out || row.size() < out->width || (row.size() > out->width && !out->has_more)) {
    return std::nullopt;
  }
  return out;
}

std::size_t time_column(const TextFile& file, Format format) {
  const auto csv = format == Format::csv ? csv_columns(file) : std::nullopt;
  return csv ? csv->index[0] : 0;
}

int csv_exponent(const TextFile& file, const CsvColumns& columns, const ReadOptions& options) {
  if (columns.nanoseconds) return 0;
  if (columns.time_exponent.value_or(0) != 0) return *columns.time_exponent;
  const int found = stamp_exponent(file, columns.index[0], options);
  const bool is_epoch =
      found == -9 && file.repaired.has_clear_unit;  // of ROS, whose header is bare
  if (!columns.time_exponent || is_epoch) return found;
  file.repaired.units = {StampUnit::s};
  file.repaired.has_clear_unit = true;
  return 0;
}

ReadStamp csv_stamp(const TextFile& file,
                    const Line& line,
                    const CsvColumns& columns,
                    int exponent) {
  CsvRow row;
  split_row(file, line, columns, row);
  return stamp_of_row(file, line, columns, row, exponent);
}

namespace {

Trajectory read_csv(TextFile& file, const ReadOptions& options) {
  if (is_nmea(first_line(file))) return read_nmea(file, options);
  const auto columns = csv_columns(file);
  if (columns && !columns->has_rotation && !options.positions) {
    throw file.error(0, csv_header(file.header().empty() ? file.comment() : file.header()).why_not);
  }
  if (!columns && !file.header().empty()) throw file.error(0, csv_header(file.header()).why_not);
  if (!columns) {
    throw file.error(0,
                     "has no header that names time, x, y, z, qx, qy, qz and qw, expected one in a "
                     "csv file");
  }
  const int exponent = csv_exponent(file, *columns, options);
  Trajectory out = joined(read_parallel(
      file,
      [&](TextFile& part) { return read_csv_part(part, *columns, exponent, options); },
      [&](const Trajectory& a, const Trajectory& b) { return follows(a, b, options.sort); }));
  file.repaired.time_column = columns->time_column;
  file.repaired.ignored_columns = columns->ignored;
  const bool is_stated = columns->is_vector || !columns->order.empty();
  file.repaired.angles = is_stated ? 0 : columns->angles.size();
  if (columns->names_frames && !out.empty() && has_frame_numbers(file, columns->index[0])) {
    file.repaired.clock = Clock::ids;
  }
  if (!columns->is_geodetic) return out;
  return local_positions(std::move(out), options, file.repaired);
}

bool has_frames(const TextFile& file) {
  const auto columns = csv_columns(file);
  return columns && columns->names_frames && has_frame_numbers(file, columns->index[0]);
}

/// Rows of the covariance that are written; 0: none.
Eigen::Index csv_axes(const TrajectoryFile& file, bool has_rotations) {
  if (file.covariances.empty()) return 0;
  return has_rotations ? 6 : 3;
}

TextWriter csv_text(const TrajectoryFile& file, const std::string&) {
  TextWriter out(',');
  const bool has_rotations = !lacks_rotations(file.poses);
  for (const char* name : {"timestamp", "x", "y", "z"}) out.word(name);
  if (has_rotations) {
    for (const char* name : {"qx", "qy", "qz", "qw"}) out.word(name);
  }
  const Eigen::Index axes = csv_axes(file, has_rotations);
  if (axes > 0) {
    for (const std::string& name : covariance_names(has_rotations)) out.word(name);
  }
  out.end_line();
  for (std::size_t i = 0; i < file.poses.size(); ++i) {
    write_row(out, file, i);
    for (Eigen::Index a = 0; a < axes; ++a) {
      for (Eigen::Index b = a; b < axes; ++b) out.number(file.covariances[i](a, b));
    }
    out.end_line();
  }
  return out;
}

}  // namespace

FormatEntry csv_format() {
  return {.format = Format::csv,
          .read = read_csv,
          .takes_times = has_frames,
          .write = csv_text,
          .contents = {.positions = true, .covariances = true, .position_covariances = true}};
}

}  // namespace loopbench
