#include "datasets/formats/detect_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "datasets/columns/columns.hpp"
#include "datasets/columns/csv_header.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/csv.hpp"
#include "datasets/formats/format_registry.hpp"
#include "datasets/formats/known_layouts.hpp"
#include "datasets/formats/nmea.hpp"

namespace loopbench {

std::optional<Format> guess(const TextFile& file, const Line& line) {
  for (const FormatEntry& each : formats()) {
    if (each.guess != nullptr && each.guess(file, line)) return each.format;
  }
  return std::nullopt;
}

InputError wrong_columns(const TextFile& file,
                         const Line& line,
                         Format reading,
                         const std::string& expected) {
  std::string what = "has " + columns_text(count_columns(file, line)) + ", expected " + expected;
  if (has_decimal_commas(line.text)) {
    what += " (decimal commas: expected decimal points)";
  } else if (line.unterminated) {
    what += " (the file ends in the middle of this line)";
  } else if (const auto format = guess(file, line); format && *format != reading) {
    what += " (looks like " + to_text(*format) + ")";
  }
  return file.error(line.number, what);
}

namespace {

/// Detects by the numbers of the first line.
Format detect_by_numbers(const TextFile& file, const Line& line) {
  if (const auto format = guess(file, line)) return *format;
  constexpr std::size_t kShownText = 40;
  std::string what = "has " + columns_text(count_columns(file, line)) + " and starts '" +
                     std::string(line.text.substr(0, kShownText)) + "'";
  if (line.text.find(';') != std::string_view::npos) {
    throw file.error(line.number,
                     what + ": found ';', expected columns separated by commas or blanks");
  }
  throw file.error(line.number,
                   what +
                       ", expected tum (8 columns, 9 with a node id, 29 or 44 with a covariance), "
                       "kitti (12 or 16 columns, one more with a stamp), euroc (whole nanoseconds "
                       "and 7 or more columns), csv (a header names the columns), NMEA ($GPGGA, "
                       "$GPRMC), g2o (VERTEX and EDGE lines), log (a matrix over four lines), json "
                       "(matrices), npy or npz, a folder with a matrix per file, or a ROS bag");
}

/// Whether the reader of `format` reads columns in this order and these units anyway.
bool is_usual_order(Format format, const CsvColumns& columns) {
  using Order = std::array<std::size_t, 8>;
  if (!columns.has_rotation || columns.nanoseconds || !columns.angles.empty() || columns.has_more ||
      columns.per_metre != std::array{1.0, 1.0, 1.0})
    return false;
  const int unit = columns.time_exponent.value_or(format == Format::euroc ? -9 : 0);
  if (format == Format::euroc) return unit == -9 && columns.index == Order{0, 1, 2, 3, 4, 5, 6, 7};
  return format == Format::tum && unit == 0 && columns.index == Order{0, 1, 2, 3, 7, 4, 5, 6};
}

/// Rejects a header row that is not understood, except for KITTI matrices and for words that name
/// no columns of the table.
void check_header(const TextFile& file, const Line& line) {
  const CsvHeader header = csv_header(file.header());
  const bool names_any = header.names_time || header.names_position || header.names_quaternion;
  const std::size_t width = count_columns(file, line);
  const bool is_matrix = width == 12 && !header.names_time && !header.names_quaternion;
  if (header.columns || is_matrix || (!names_any && header.width != width)) return;
  throw file.error(0, header.why_not);
}

/// Rejects a comment that names the columns of the rows below, if it is not understood.
void check_comment(const TextFile& file, const Line& line) {
  const CsvHeader header = csv_header(file.comment());
  const bool names_columns =
      header.names_time && header.names_position && header.width == count_columns(file, line);
  if (names_columns && !header.columns) throw file.error(0, header.why_not);
}

}  // namespace

Format detect_format(TextFile& file) {
  const Line line = first_line(file);
  if (is_nmea(line)) return Format::csv;
  if (has_decimal_commas(line.text))
    throw file.error(line.number, "has decimal commas, expected decimal points");
  const auto columns = csv_columns(file);
  if (!file.header().empty()) {
    if (columns) return Format::csv;
    check_header(file, line);
  } else if (!columns || is_of_colmap(file, line)) {
    reject_known(file, line);
    if (!columns) check_comment(file, line);
  }
  if (!columns) return detect_by_numbers(file, line);
  try {
    const Format found = detect_by_numbers(file, line);
    const std::string_view stamp = Columns(file, line).word();
    const bool is_plain = stamp == stamp_word(stamp) && is_usual_order(found, *columns);
    return found == Format::g2o || is_plain ? found : Format::csv;
  } catch (const InputError&) {
    return Format::csv;  // only the comment above the first line names its columns
  }
}

const FormatEntry* detect_file(const std::filesystem::path& file) {
  const auto all = formats();
  const auto found = std::ranges::find_if(all, [&](const FormatEntry& each) {
    return each.guess_file != nullptr && each.guess_file(file);
  });
  return found == all.end() ? nullptr : &*found;
}

Format detect_format(const std::filesystem::path& file) {
  if (const FormatEntry* const found = detect_file(file)) return found->format;
  TextFile text(file);
  text.skip_header();
  return detect_format(text);
}

bool takes_times(const std::filesystem::path& file, Format format) {
  const FormatEntry& entry = entry_of(format);
  if (entry.read_file != nullptr)
    return format != Format::bag && !entry.read_file(file, {}).has_stamps;
  if (entry.takes_times == nullptr) return false;
  TextFile text(file);
  text.skip_header();
  return entry.takes_times(text);
}

bool can_take_times(const std::filesystem::path& file, Format format) {
  if (entry_of(format).read == nullptr) return false;
  TextFile text(file);
  text.skip_header();
  return can_be_frame_numbers(text, time_column(text, format));
}

std::string why_no_common_time(const FileClock& one, const FileClock& other) {
  const bool is_first = one.clock == Clock::stamps;
  if (is_first != (other.clock == Clock::stamps)) {
    return fmt::format(
        "{} has no stamps, and {} has: expected one time for each row (--times) or --period",
        (is_first ? other : one).name,
        (is_first ? one : other).name);
  }
  const bool by_rows = one.clock == Clock::rows || other.clock == Clock::rows;
  if (!by_rows || one.rows == other.rows) return "";
  return fmt::format(
      "{} has {} rows and {} has {}; neither has stamps, so corresponding rows are unknown: "
      "expected times, one for each row (traj convert FILE --times TIMES -o NEW)",
      one.name,
      one.rows,
      other.name,
      other.rows);
}

}  // namespace loopbench
