/// Parser for the columns of one line, without copies.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "datasets/columns/reading.hpp"
#include "datasets/columns/short_number.hpp"
#include "datasets/columns/stamps.hpp"
#include "datasets/columns/text_file.hpp"

namespace loopbench {

class Columns {
 public:
  /// `index`: of the first column of `line`.
  Columns(const TextFile& file, const Line& line, std::size_t index = 0)
      : file_(file),
        line_(line),
        at_(line.text.data()),
        end_(at_ + line.text.size()),
        index_(index) {
    skip_separators();
  }

  bool done() const { return at_ == end_; }
  std::size_t index() const { return index_; }  ///< columns read so far

  /// Returns the next column as text; empty at the end of the line.
  std::string_view word() {
    const std::string_view out = peek();
    advance(at_ + out.size());
    return out;
  }

  /// Returns the next column as a finite number. Throws InputError with the column name `what`.
  double number(const char* what) {
    double value = 0.0;
    if (file_.has_short_numbers()) {
      const char* const stop = short_number(at_, end_, value);
      if (stop != nullptr && ends_column(stop)) {
        advance(stop);
        return value;
      }
      file_.count_long_number();
    }
    const char* const first = at_ + (at_ != end_ && *at_ == '+' ? 1 : 0);
    const auto [stop, error] = std::from_chars(first, end_, value);
    const bool signed_twice = first != at_ && first != end_ && *first == '-';
    const bool valid = error == std::errc{} && ends_column(stop) && !signed_twice;
    if (!valid || !std::isfinite(value)) reject_number(what, error, stop);
    advance(stop);
    return value;
  }

  /// Returns the next column as a 64-bit integer. Throws InputError with the column name `what`.
  std::int64_t integer(const char* what) {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(at_, end_, value);
    if (error != std::errc{} || !ends_column(stop)) reject_integer(what, error, stop);
    advance(stop);
    return value;
  }

  /// Returns the next column without advancing.
  std::string_view peek() const {
    const char* stop = at_;
    while (!ends_column(stop)) ++stop;
    return {at_, static_cast<std::size_t>(stop - at_)};
  }

 private:
  static bool separates(char c) { return c == ' ' || c == ',' || c == '\t'; }
  bool ends_column(const char* at) const { return at == end_ || separates(*at); }

  void skip_separators() {
    while (at_ != end_ && separates(*at_)) ++at_;
  }

  void advance(const char* stop) {
    at_ = stop;
    ++index_;
    skip_separators();
  }

  [[noreturn]] void reject_number(const char* what, std::errc error, const char* stop) const;
  [[noreturn]] void reject_integer(const char* what, std::errc error, const char* stop) const;
  InputError refusal(const char* what, const std::string& why) const;

  const TextFile& file_;
  const Line& line_;
  const char* at_;
  const char* end_;
  std::size_t index_;
};

/// Returns the next column as a stamp in units of 10^exponent seconds. Throws InputError.
inline ReadStamp next_stamp(Columns& columns, int exponent) {
  const std::string_view word = columns.peek();
  return read_stamp(word, columns.number("stamp"), exponent);
}

/// Returns the number of columns of a line.
std::size_t count_columns(const TextFile& file, const Line& line);

/// "1 column", "8 columns"
std::string columns_text(std::size_t count);

/// Whether a line has numbers like "0,5" between spaces, with one comma at most, and no point.
bool has_decimal_commas(std::string_view text);

/// Whether a word is the tag of a line of g2o.
bool is_graph_tag(std::string_view word);

}  // namespace loopbench
