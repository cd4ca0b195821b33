/// Numbers as trajectory files contain them, faster than std::from_chars.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace loopbench {

/// Appends the decimal digits from `at` to `digits`, modulo 2^64; returns the end of them.
inline const char* read_digits(const char* at, const char* end, std::uint64_t& digits) {
  static constexpr std::array<std::uint64_t, 9> kPowers{
      1, 10, 100, 1000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};
  if constexpr (std::endian::native == std::endian::little) {
    while (end - at >= 8) {  // eight characters at once
      std::uint64_t word = 0;
      std::memcpy(&word, at, sizeof word);
      word ^= 0x3030303030303030;  // digits become 0 to 9
      const std::uint64_t others = ((word + 0x7676767676767676) | word) & 0x8080808080808080;
      const int count = others == 0 ? 8 : std::countr_zero(others) / 8;
      if (count == 0) return at;
      word <<= 64 - 8 * count;  // zeros before the digits
      word = 10 * word + (word >> 8);
      word = ((word & 0x000000ff000000ff) * 0x000f424000000064 +
              ((word >> 16) & 0x000000ff000000ff) * 0x0000271000000001) >>
             32;
      digits = digits * kPowers[static_cast<std::size_t>(count)] + word;
      at += count;
      if (count < 8) return at;
    }
  }
  for (; at != end && '0' <= *at && *at <= '9'; ++at) {
    digits = 10 * digits + static_cast<unsigned>(*at - '0');
  }
  return at;
}

/// Reads digits with an optional minus sign and an optional decimal point, without an exponent, at
/// most 15 of them (16 below 2^53). Returns the end of the number; nullptr for all else, which
/// std::from_chars then reads or rejects. The value has the same bits as std::from_chars': digits
/// below 2^53 and powers of ten up to 10^22 are exact doubles, so that one division rounds once
/// (Clinger, PLDI 1990).
inline const char* short_number(const char* at, const char* end, double& value) {
  static constexpr std::array<double, 17> kPowers{
      1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16};
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  const bool is_negative = at != end && *at == '-';
  at += is_negative ? 1 : 0;
  std::uint64_t digits = 0;
  const char* const first = at;
  at = read_digits(at, end, digits);
  std::ptrdiff_t count = at - first;
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == '.') {
    const char* const after_point = at + 1;
    at = read_digits(after_point, end, digits);
    decimals = at - after_point;
    count += decimals;
  }
  const bool has_exponent = at != end && (*at == 'e' || *at == 'E');
  if (count < 1 || count > 16 || digits > kExact || has_exponent) return nullptr;
  const double size = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
  // Without a branch, which signs in random order would mislead.
  value =
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) | std::uint64_t{is_negative} << 63);
  return at;
}

}  // namespace loopbench
