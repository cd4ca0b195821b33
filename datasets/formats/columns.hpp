/// Walks the columns of one line: numbers are parsed in place, nothing is copied.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "datasets/formats/formats.hpp"
#include "datasets/formats/text_file.hpp"

namespace loopbench {

class Columns {
 public:
  Columns(const TextFile& file, const Line& line)
      : file_(file), line_(line), at_(line.text.data()), end_(at_ + line.text.size()) {
    skip_separators();
  }

  bool done() const { return at_ == end_; }
  std::size_t index() const { return index_; }  ///< columns read so far

  /// The next column as text; empty when there is none.
  std::string_view word() {
    const std::string_view out = peek();
    advance(at_ + out.size());
    return out;
  }

  /// The next column as a finite number. `what` names it in the refusal.
  double number(const char* what) {
    double value = 0.0;
    const char* const first = at_ + (at_ != end_ && *at_ == '+' ? 1 : 0);
    const auto [stop, error] = std::from_chars(first, end_, value);
    const bool signed_twice = first != at_ && first != end_ && *first == '-';
    const bool good = error == std::errc{} && ends_column(stop) && !signed_twice;
    if (!good || !std::isfinite(value)) refuse_number(what, error, stop);
    advance(stop);
    return value;
  }

  /// The next column as a whole number of 64 bits.
  std::int64_t integer(const char* what) {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(at_, end_, value);
    if (error != std::errc{} || !ends_column(stop)) refuse_integer(what, error, stop);
    advance(stop);
    return value;
  }

  /// The next column without moving on.
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

  [[noreturn]] void refuse_number(const char* what, std::errc error, const char* stop) const;
  [[noreturn]] void refuse_integer(const char* what, std::errc error, const char* stop) const;
  InputError refusal(const char* what, const std::string& why) const;

  const TextFile& file_;
  const Line& line_;
  const char* at_;
  const char* end_;
  std::size_t index_ = 0;
};

/// How many columns a line has.
std::size_t count_columns(const TextFile& file, const Line& line);

/// "has 7 columns, expected `expected`", with a word on truncation, or on the format it looks like
/// when that is not the one being read.
InputError wrong_columns(const TextFile& file,
                         const Line& line,
                         Format reading,
                         const std::string& expected);

}  // namespace loopbench
