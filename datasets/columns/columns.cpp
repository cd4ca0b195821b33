#include "datasets/columns/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "datasets/formats/detect_format.hpp"

namespace loopbench {

InputError Columns::refusal(const char* what, const std::string& why) const {
  constexpr std::size_t kMaxShown = 40;
  const std::string_view column = peek();
  const char* const ellipsis = column.size() > kMaxShown ? "..." : "";
  // A tag in place of a number means that the file has another format.
  const bool tag = index_ == 0 && guess(file_, line_) == Format::g2o;
  return file_.error(line_.number,
                     fmt::format("column {} ({}): '{}{}' {}{}",
                                 index_ + 1,
                                 what,
                                 column.substr(0, kMaxShown),
                                 ellipsis,
                                 why,
                                 tag ? " (looks like g2o)" : ""));
}

void Columns::reject_number(const char* what, std::errc error, const char* stop) const {
  if (error == std::errc::result_out_of_range && ends_column(stop)) {
    throw refusal(what, "is out of the range of a double");
  }
  if (error == std::errc{} && ends_column(stop) && peek().substr(0, 2) != "+-") {
    throw InvalidRow(refusal(what, "is not finite, expected a number"));
  }
  constexpr std::array kMissing{"", "None", "null", "NULL", "NA"};  // of programs that write tables
  if (std::ranges::count(kMissing, peek()) > 0) throw InvalidRow(refusal(what, "is not a number"));
  throw refusal(what, "is not a number");
}

void Columns::reject_integer(const char* what, std::errc error, const char* stop) const {
  if (error == std::errc::result_out_of_range && ends_column(stop)) {
    throw refusal(what, "is out of the range of a 64-bit whole number");
  }
  throw refusal(what, "is not a whole number");
}

std::size_t count_columns(const TextFile& file, const Line& line) {
  Columns columns(file, line);
  while (!columns.done()) columns.word();
  return columns.index();
}

std::string columns_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " column" : " columns");
}

namespace {

/// Numbers as "0,5" between spaces, with one comma at most, and none with a point.
bool has_decimal_commas(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.find(',') == text.npos || text.find(' ') == text.npos || text.find('.') != text.npos)
    return false;
  bool has_comma = false;  // in this number
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ') has_comma = false;
    if (text[i] != ',') continue;
    const bool is_inside = i > 0 && i + 1 < text.size();
    if (has_comma || !(is_inside && is_digit(text[i - 1]) && is_digit(text[i + 1]))) return false;
    has_comma = true;
  }
  return true;
}

}  // namespace

void reject_decimal_commas(const TextFile& file, const Line& line) {
  if (has_decimal_commas(line.text))
    throw file.error(line.number, "has decimal commas, expected decimal points");
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

}  // namespace loopbench
