#include "datasets/formats/detect_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/columns/columns.hpp"
#include "datasets/columns/stamp_unit.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/formats/text_formats.hpp"

namespace loopbench {
namespace {

bool is_tag(std::string_view word) {
  return word.starts_with("VERTEX") || word.starts_with("EDGE") || word.starts_with("PARAMS_") ||
         word == "FIX";
}

/// EuRoC stamps are nanoseconds since 1970: no decimal point, and more digits than microseconds.
bool is_nanoseconds(std::string_view word) {
  constexpr std::size_t kMinDigits = 17;
  return word.size() >= kMinDigits &&
         std::all_of(word.begin(), word.end(), [](char c) { return '0' <= c && c <= '9'; });
}

/// Sum of the squares of some columns; not a number if one is no number.
double square_of_columns(const TextFile& file, const Line& line, std::size_t first, int count) {
  Columns columns(file, line);
  for (std::size_t i = 0; i < first; ++i) columns.word();
  double out = 0.0;
  for (int i = 0; i < count; ++i) {
    const std::string_view word = columns.word();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size()) return std::nan("");
    out += value * value;
  }
  return out;
}

bool is_one(double square) { return std::abs(square - 1.0) <= 1e-3; }

/// Whether a line has a 4 x 4 matrix, or a matrix after a stamp, whose first two rows begin with
/// unit vectors.
bool is_other_matrix(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  const std::size_t first = count == 16 ? 0 : 1;
  return (count == 13 || count == 16 || count == 17) &&
         is_one(square_of_columns(file, line, first, 3)) &&
         is_one(square_of_columns(file, line, first + 4, 3));
}

/// Whether the stamps of a file are whole numbers that cannot be seconds.
bool has_whole_ticks(const TextFile& file, std::string_view stamp) {
  const bool is_whole = stamp.find_first_not_of("0123456789") == stamp.npos;
  return is_whole && fitting_units(file, 0).units.front() != StampUnit::s;
}

}  // namespace

bool has_node_id(const TextFile& file, const Line& line) {
  const bool is_in_seconds = Columns(file, line).word().find('.') != std::string_view::npos;
  return is_in_seconds && count_columns(file, line) == 9 &&
         is_one(square_of_columns(file, line, 4, 4));
}

bool takes_times(const TextFile& file, Format format) {
  TextFile reopened = file.reopened();
  const auto csv = format == Format::csv ? csv_columns(file) : std::nullopt;
  if (csv) return csv->names_frames && has_frame_numbers(file, csv->index[0]);
  if (format != Format::kitti) return false;
  const std::size_t count = count_columns(file, first_line(reopened));
  return (count != 13 && count != 17) || has_frame_numbers(file, 0);
}

std::optional<Format> guess(const TextFile& file, const Line& line) {
  const std::string_view first = Columns(file, line).word();
  if (is_tag(first)) return Format::g2o;
  const std::size_t count = count_columns(file, line);
  if (is_nanoseconds(first) && (count >= 8 || count == 4)) return Format::euroc;
  if (!stamp_number(first)) return std::nullopt;
  if (count == 12) return Format::kitti;
  if (has_node_id(file, line)) return Format::tum;
  if (count == 8 || count == 4 || count == 29 || count == 44) return Format::tum;
  return std::nullopt;
}

Line first_line(TextFile& file) {
  Line line;
  if (!file.next(line)) throw file.error(0, "contains no data, only comments and blank lines");
  file.put_back(line);
  return line;
}

namespace {

/// Whether the first lines are the rows of a 4 x 4 matrix, perhaps below a line of numbers.
bool has_matrix_lines(const TextFile& file) {
  TextFile reopened = file.reopened();
  Line line;
  if (!reopened.next(line)) return false;
  if (count_columns(file, line) != 4 && !reopened.next(line)) return false;
  const bool begins = count_columns(file, line) == 4 && is_one(square_of_columns(file, line, 0, 3));
  for (int i = 0; i < 3; ++i) reopened.next(line);
  return begins && count_columns(file, line) == 4 && square_of_columns(file, line, 0, 3) == 0.0;
}

/// A number, a quaternion, a position, the number of a camera, and a name.
bool is_of_colmap(const TextFile& file, const Line& line) {
  return count_columns(file, line) == 10 && is_one(square_of_columns(file, line, 1, 4)) &&
         std::isnan(square_of_columns(file, line, 9, 1));
}

/// Throws InputError with the command that converts a file, if it has a known layout without a
/// reader.
void reject_known(const TextFile& file, const Line& line) {
  const std::size_t count = count_columns(file, line);
  const auto is_unit = [&](std::size_t first, int n) {
    return is_one(square_of_columns(file, line, first, n));
  };
  std::string what;
  if (line.text.starts_with('{') || line.text.starts_with('[')) {
    what =
        "is JSON, expected rows of numbers; for a list of objects with t, x, y, z and a "
        "quaternion: jq -r '.[] | [.t, .x, .y, .z, .qx, .qy, .qz, .qw] | @tsv' FILE > poses.txt";
  } else if (is_of_colmap(file, line)) {
    what =
        "has 10 columns as images.txt of COLMAP (camera_from_world): awk '!/^#/ && ++n%2 {print "
        "$1,$6,$7,$8,$3,$4,$5,$2}' FILE > images.tum; loopbench traj transform images.tum "
        "--sort --invert-poses -o poses.txt; stamps are numbers of images, or take the time "
        "from the name in column 10";
  } else if (count == 7 && is_unit(3, 4)) {
    what =
        "has 7 columns, a pose x y z qx qy qz qw without a stamp? Expected one in the first "
        "column: paste -d' ' TIMES FILE > poses.txt, with one time per line";
  } else if (count == 7) {
    what =
        "has 7 columns, a stamp, a position and three angles? Expected a quaternion; for the "
        "positions alone: awk '{print $1,$2,$3,$4}' FILE > poses.txt";
  } else if ((count == 3 || count == 4) && has_matrix_lines(file)) {
    what =
        "has a 4 x 4 matrix over four lines, expected one line: awk 'NF == 4' FILE | "
        "paste -d' ' - - - - > poses.txt";
  }
  if (what.empty()) return;
  throw file.error(line.number, what.replace(what.find("FILE"), 4, file.name()));
}

/// Detects by the numbers of the first lines.
Format detect_by_numbers(const TextFile& file, const Line& line) {
  if (is_other_matrix(file, line)) return Format::kitti;
  const std::string_view stamp = Columns(file, line).word();
  const std::size_t count = count_columns(file, line);
  const bool has_ticks = has_whole_ticks(file, stamp);
  const bool is_orb_slam3 = has_ticks && count == 8 && line.text.find(',') == line.text.npos;
  if (is_orb_slam3) return Format::tum;  // files of EuRoC have commas
  if (has_ticks && count >= 8 && count != 12) return Format::euroc;
  if (const auto format = guess(file, line)) return *format;
  constexpr std::size_t kShownText = 40;
  std::string what = "has " + columns_text(count) + " and starts '" +
                     std::string(line.text.substr(0, kShownText)) + "'";
  if (line.text.find(';') != std::string_view::npos) {
    throw file.error(line.number,
                     what + ": found ';', expected columns separated by commas or blanks");
  }
  throw file.error(line.number,
                   what +
                       ", expected tum (8 columns, 9 with a node id, 29 or 44 with a covariance), "
                       "kitti (12 or 16 columns, one more with a stamp), euroc (whole nanoseconds "
                       "and 7 or more columns) or g2o (VERTEX and EDGE lines)");
}

/// Whether the reader of `format` reads columns in this order and these units anyway.
bool is_usual_order(Format format, const CsvColumns& columns) {
  using Order = std::array<std::size_t, 8>;
  if (!columns.has_rotation || columns.nanoseconds ||
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

}  // namespace

Format detect_format(TextFile& file) {
  const Line line = first_line(file);
  reject_decimal_commas(file, line);
  const auto columns = csv_columns(file);
  if (!file.header().empty()) {
    if (columns) return Format::csv;
    check_header(file, line);
  } else if (!columns || is_of_colmap(file, line)) {
    reject_known(file, line);
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

Format detect_format(const std::filesystem::path& file) {
  if (names_bag(file.string()) || bag_kind(open_input(file)) != BagKind::none) return Format::bag;
  TextFile text(file);
  text.skip_header();
  return detect_format(text);
}

bool takes_times(const std::filesystem::path& file, Format format) {
  if (format != Format::kitti && format != Format::csv) return false;
  TextFile text(file);
  text.skip_header();
  return takes_times(text, format);
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
      "{} has {} rows and {} has {}, both without stamps, so that rows of one time are not known: "
      "expected times, one for each row (traj convert FILE --times TIMES -o NEW)",
      one.name,
      one.rows,
      other.name,
      other.rows);
}

}  // namespace loopbench
