#include <array>
#include <cmath>
#include <vector>

#include "datasets/formats/covariance_columns.hpp"
#include "datasets/formats/detect_format.hpp"
#include "datasets/formats/parts.hpp"
#include "datasets/formats/pose_rules.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

using CsvRow = std::vector<std::string_view>;

void split_row(const TextFile& file, const Line& line, const CsvColumns& columns, CsvRow& row) {
  split_columns(line.text, row);
  if (row.size() + 1 == columns.width && line.text.ends_with(',')) row.emplace_back();
  if (row.size() == columns.width) return;
  throw file.error(line.number,
                   "has " + columns_text(row.size()) + ", expected " +
                       std::to_string(columns.width) + " as in the header" +
                       (line.unterminated ? " (the file ends in the middle of this line)" : ""));
}

double csv_number(const TextFile& file, const Line& line, std::string_view text, const char* what) {
  Line column = line;
  column.text = text;
  Columns parsed(file, column);
  const double out = parsed.number(what);
  if (parsed.done()) return out;
  throw file.error(line.number,
                   "column " + std::string(what) + ": '" + std::string(text) + "' is not a number");
}

/// Whole seconds and a column of nanoseconds, as in messages of ROS.
ReadStamp split_stamp(const TextFile& file,
                      const Line& line,
                      std::string_view seconds,
                      std::string_view nanoseconds) {
  const double whole = csv_number(file, line, seconds, "seconds");
  const double rest = csv_number(file, line, nanoseconds, "nanoseconds");
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
                       const CsvRow& row) {
  const std::string_view text = row[columns.index[0]];
  if (columns.nanoseconds) return split_stamp(file, line, text, row[*columns.nanoseconds]);
  const double number = csv_number(file, line, text, kPoseColumns[0]);
  int exponent = columns.time_exponent.value_or(0);
  if (exponent == 0 && is_in_nanoseconds(number, false)) exponent = -9;
  return read_stamp(text, number, exponent);
}

/// False for a NavSatFix without a position, whose coordinates need not be numbers.
bool has_fix(const TextFile& file, const Line& line, const CsvColumns& columns, const CsvRow& row) {
  if (!columns.fix || csv_number(file, line, row[*columns.fix], "status") >= 0.0) return true;
  ++file.repaired.without_fix;
  return false;
}

Matrix6 covariance_of_row(const TextFile& file,
                          const Line& line,
                          const CsvColumns& columns,
                          const CsvRow& row) {
  const Eigen::Index axes = columns.has_rotation ? 6 : 3;
  Matrix6 out = Matrix6::Zero();
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < axes; ++i) {
    for (Eigen::Index j = i; j < axes; ++j) {
      const std::string_view text = row[columns.covariance[k++]];
      out(i, j) = out(j, i) = csv_number(file, line, text, "covariance");
    }
  }
  if (is_covariance(out, columns.has_rotation)) return out;
  throw file.error(line.number, "covariance is not positive definite");
}

Trajectory read_csv_part(TextFile& file, const CsvColumns& columns, const ReadOptions& options) {
  Trajectory out;
  StampOrder order(file, options.repeats);
  CsvRow row;
  std::array<double, kPoseColumns.size()> v{};
  for (Line line; file.next(line);) {
    split_row(file, line, columns, row);
    if (!has_fix(file, line, columns, row)) continue;
    const double stamp = stamp_of_row(file, line, columns, row).seconds;
    for (std::size_t i = 1; i < (columns.has_rotation ? v.size() : 4); ++i) {
      v[i] = csv_number(file, line, row[columns.index[i]], kPoseColumns[i]);
    }
    for (std::size_t i = 0; i < columns.per_metre.size(); ++i) v[1 + i] /= columns.per_metre[i];
    const Vector3 position(v[1], v[2], v[3]);
    if (columns.is_geodetic) require_degrees(file, line.number, position);
    const Rotation rotation =
        columns.has_rotation
            ? rotation_of_row(file, line, {v[4], v[5], v[6], v[7]}, out, options.positions)
            : no_rotation();
    order.put(stamp, line.number, {rotation, position}, out);
    if (columns.covariance.empty()) continue;
    put_covariance(file, covariance_of_row(file, line, columns, row), out.size(), options.repeats);
  }
  return out;
}

}  // namespace

std::optional<CsvColumns> csv_columns(const TextFile& file) {
  const bool is_row = !file.header().empty();
  auto out = csv_header(is_row ? file.header() : file.comment()).columns;
  if (!out) return std::nullopt;
  if (!is_row) {
    TextFile reopened = file.reopened();
    Line line;
    CsvRow row;
    if (reopened.next(line)) split_columns(line.text, row);
    if (row.size() != out->width) return std::nullopt;
  }
  const bool is_stated = out->time_exponent || out->nanoseconds;
  if (!is_stated && out->index[0] == 0 && has_small_nanoseconds(file)) out->time_exponent = -9;
  return out;
}

ReadStamp csv_stamp(const TextFile& file, const Line& line, const CsvColumns& columns) {
  CsvRow row;
  split_row(file, line, columns, row);
  return stamp_of_row(file, line, columns, row);
}

Trajectory read_csv(TextFile& file, const ReadOptions& options) {
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
  Trajectory out = joined(read_parallel(
      file,
      [&](TextFile& part) { return read_csv_part(part, *columns, options); },
      [](const Trajectory& a, const Trajectory& b) {
        return !a.empty() && !b.empty() && follows(a, b);
      }));
  if (!columns->is_geodetic) return out;
  return local_positions(std::move(out), options);
}

}  // namespace loopbench
