#include "datasets/formats/detect_format.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/formats/columns.hpp"
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

/// Whether a line has a stamp and a 3 x 4 matrix whose first two rows begin with unit vectors.
bool is_stamped_matrix(const TextFile& file, const Line& line) {
  return count_columns(file, line) == 13 && is_one(square_of_columns(file, line, 1, 3)) &&
         is_one(square_of_columns(file, line, 5, 3));
}

}  // namespace

bool has_node_id(const TextFile& file, const Line& line) {
  const bool is_in_seconds = Columns(file, line).word().find('.') != std::string_view::npos;
  return is_in_seconds && count_columns(file, line) == 9 &&
         is_one(square_of_columns(file, line, 4, 4));
}

bool has_small_nanoseconds(const TextFile& file) {
  constexpr std::int64_t kMinStep = 100'000;             // [ns]
  constexpr std::int64_t kMost = 1'000'000'000'000'000;  // [ns]; microseconds since 1970 are above
  TextFile reopened = file.reopened();
  std::optional<std::int64_t> previous;
  for (int i = 0; i < 2; ++i) {
    Line line;
    if (!reopened.next(line)) return false;
    const auto stamp = exact_nanoseconds(Columns(reopened, line).word(), -9);
    if (!stamp || *stamp < 0 || *stamp > kMost) return false;
    if (previous) return *stamp - *previous >= kMinStep;
    previous = stamp;
  }
  return false;
}

std::optional<Format> guess(const TextFile& file, const Line& line) {
  const std::string_view first = Columns(file, line).word();
  if (is_tag(first)) return Format::g2o;
  const std::size_t count = count_columns(file, line);
  if (is_nanoseconds(first) && (count >= 8 || count == 4)) return Format::euroc;
  if (first.find_first_not_of("+-.0123456789eE") != std::string_view::npos) return std::nullopt;
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

/// Detects by the numbers of the first lines.
Format detect_by_numbers(const TextFile& file, const Line& line) {
  if (is_stamped_matrix(file, line)) return Format::kitti;
  const std::string_view stamp = Columns(file, line).word();
  const bool is_integer = stamp.find_first_not_of("0123456789") == stamp.npos;
  const bool is_small = is_integer && has_small_nanoseconds(file);
  const bool is_orb_slam3 = (is_small || is_nanoseconds(stamp)) && count_columns(file, line) == 8 &&
                            line.text.find(',') == std::string_view::npos;
  if (is_orb_slam3) return Format::tum;  // files of EuRoC have commas
  if (is_small && count_columns(file, line) >= 8) return Format::euroc;
  if (const auto format = guess(file, line)) return *format;
  constexpr std::size_t kShownText = 40;
  const std::size_t count = count_columns(file, line);
  std::string what = "has " + columns_text(count) + " and starts '" +
                     std::string(line.text.substr(0, kShownText)) + "'";
  if (line.text.find(';') != std::string_view::npos) {
    throw file.error(line.number,
                     what + ": found ';', expected columns separated by commas or blanks");
  }
  throw file.error(line.number,
                   what +
                       ", expected tum (8 columns, 9 with a node id, 29 or 44 with a covariance), "
                       "kitti (12 columns, 13 with a stamp), euroc (whole nanoseconds and 7 or "
                       "more columns) or g2o (VERTEX and EDGE lines)");
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
  const auto columns = csv_columns(file);
  if (!file.header().empty()) {
    if (columns) return Format::csv;
    check_header(file, line);
  }
  if (!columns) return detect_by_numbers(file, line);
  try {
    const Format found = detect_by_numbers(file, line);
    return found == Format::g2o || is_usual_order(found, *columns) ? found : Format::csv;
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

}  // namespace loopbench
