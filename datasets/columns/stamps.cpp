#include "datasets/columns/stamps.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace loopbench {
namespace {

constexpr int kDecimals = 9;  // of a second in nanoseconds

bool is_digit(char c) { return '0' <= c && c <= '9'; }

}  // namespace

std::string_view stamp_word(std::string_view column) {
  const bool is_name = !column.empty() && std::isalpha(static_cast<unsigned char>(column.back()));
  const std::size_t dot = column.rfind('.');
  if (!is_name || dot == column.npos) return column;
  column = column.substr(0, dot);
  const std::size_t before = column.find_last_not_of("0123456789.");
  if (before != column.npos) column.remove_prefix(before + 1);
  return column;
}

std::optional<double> stamp_number(std::string_view column) {
  std::string_view word = stamp_word(column);
  if (word.starts_with('+')) word.remove_prefix(1);
  double out = 0.0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  if (error != std::errc{} || rest != word.data() + word.size()) return std::nullopt;
  return out;
}

double seconds_of(std::int64_t nanoseconds) {
  constexpr std::int64_t kPerSecond = 1'000'000'000;
  const std::int64_t seconds = nanoseconds / kPerSecond;
  return static_cast<double>(seconds) +
         static_cast<double>(nanoseconds % kPerSecond) / static_cast<double>(kPerSecond);
}

ReadStamp read_stamp(std::string_view word, double number, int exponent) {
  const auto exact = exact_nanoseconds(word, exponent);
  if (exponent == 0) return {number, exact};
  return {exact ? seconds_of(*exact) : number * std::pow(10.0, exponent), exact};
}

std::optional<std::int64_t> exact_nanoseconds(std::string_view word, int exponent) {
  const bool is_negative = word.starts_with('-');
  if (is_negative || word.starts_with('+')) word.remove_prefix(1);
  const std::size_t tail = std::min(word.find_first_of("eE"), word.size());
  if (tail < word.size()) {
    std::string_view digits = word.substr(tail + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    int stated = 0;
    const auto [rest, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), stated);
    constexpr int kMostExponent = 30;
    if (error != std::errc{} || rest != digits.data() + digits.size()) return std::nullopt;
    if (std::abs(stated) > kMostExponent) return std::nullopt;
    exponent += stated;
  }
  std::string digits;
  int decimals = 0;
  bool after_point = false;
  for (const char c : word.substr(0, tail)) {
    if (c == '.' && !after_point) {
      after_point = true;
    } else if (is_digit(c)) {
      digits += c;
      decimals += after_point ? 1 : 0;
    } else {
      return std::nullopt;
    }
  }
  if (digits.empty()) return std::nullopt;
  for (decimals -= exponent; decimals > kDecimals; --decimals) {
    if (digits.back() != '0') return std::nullopt;
    digits.pop_back();
    if (digits.empty()) return 0;
  }
  digits.append(static_cast<std::size_t>(kDecimals - decimals), '0');
  std::int64_t out = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), out);
  if (error != std::errc{}) return std::nullopt;
  return is_negative ? -out : out;
}

std::string seconds_text(std::int64_t nanoseconds) {
  std::string digits = std::to_string(nanoseconds);
  const std::string sign = nanoseconds < 0 ? "-" : "";
  digits.erase(0, sign.size());
  if (digits.size() <= kDecimals) digits.insert(0, kDecimals + 1 - digits.size(), '0');
  digits.insert(digits.size() - kDecimals, ".");
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return sign + digits;
}

}  // namespace loopbench
