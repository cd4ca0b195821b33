#include "datasets/columns/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace loopbench {

InputError Columns::refusal(const char* what, const std::string& why) const {
  constexpr std::size_t kMaxShown = 40;
  const std::string_view column = peek();
  const char* const ellipsis = column.size() > kMaxShown ? "..." : "";
  // A tag in place of a number means that the file has another format.
  const bool tag = index_ == 0 && is_graph_tag(column);
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

bool is_graph_tag(std::string_view word) {
  return word.starts_with("VERTEX") || word.starts_with("EDGE") || word.starts_with("PARAMS_") ||
         word == "FIX";
}

}  // namespace loopbench
