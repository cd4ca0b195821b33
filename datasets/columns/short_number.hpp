/// Numbers as trajectory files contain them, faster than std::from_chars.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <system_error>

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

/// `digits` times ten to the `power`, rounded to the nearest double; false if that takes more work
/// than this. Powers up to 10^22 are exact doubles (Clinger, PLDI 1990), up to 10^27 exact numbers
/// of 64 bits. Rounding those again to 53 bits changes nothing, unless they are halfway between two
/// doubles.
inline bool scale_by_ten(std::uint64_t digits, std::ptrdiff_t power, double& value) {
  static constexpr std::array<long double, 28> kPowers{
      1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,  1e8L,  1e9L,
      1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L,
      1e20L, 1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
  static constexpr std::array<double, 23> kDoubles{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const auto size = static_cast<std::size_t>(power < 0 ? -power : power);
  if (digits <= std::uint64_t{1} << 53 && size < kDoubles.size()) {
    const auto exact = static_cast<double>(digits);
    value = power < 0 ? exact / kDoubles[size] : exact * kDoubles[size];
    return true;
  }
  if constexpr (std::numeric_limits<long double>::digits == 64) {
    if (digits >> 63 != 0 || size >= kPowers.size()) return false;
    const auto exact = static_cast<long double>(static_cast<std::int64_t>(digits));
    const long double rounded = power < 0 ? exact / kPowers[size] : exact * kPowers[size];
    std::uint64_t bits = 0;  // the first one is set
    std::memcpy(&bits, &rounded, sizeof bits);
    value = static_cast<double>(rounded);
    return (bits & 0x7ff) != 0x400;
  }
  return false;
}

/// Number of digits in [at, end), which may contain a decimal point, without leading zeros.
inline std::ptrdiff_t significant_digits(const char* at, const char* end) {
  while (at != end && (*at == '0' || *at == '.')) ++at;
  return end - at - std::count(at, end, '.');
}

/// Reads digits, at most 19 after leading zeros, with an optional minus sign, decimal point and
/// exponent. Returns the end of the number; nullptr for all else, which std::from_chars then reads
/// or rejects. The value has the same bits as std::from_chars'.
inline const char* short_number(const char* at, const char* end, double& value) {
  constexpr std::ptrdiff_t kMostDigits = 19;  // 10^19 is below 2^64
  const char* const begin = at;
  const bool is_negative = at != end && *at == '-';
  at += is_negative ? 1 : 0;
  const char* const first = at;
  std::uint64_t digits = 0;
  at = read_digits(at, end, digits);
  std::ptrdiff_t count = at - first;
  std::ptrdiff_t power = 0;
  if (at != end && *at == '.') {
    const char* const after_point = ++at;
    at = read_digits(at, end, digits);
    power = after_point - at;
    count -= power;
  }
  if (count == 0) return nullptr;
  // Leading zeros are not skipped as they are read: a random number of them would mislead a branch.
  if (count > kMostDigits && significant_digits(first, at) > kMostDigits) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) {
    ++at;
    const bool is_small = at != end && *at == '-';
    at += at != end && (*at == '-' || *at == '+') ? 1 : 0;
    const char* const first_of_exponent = at;
    std::uint64_t exponent = 0;
    at = read_digits(at, end, exponent);
    if (at == first_of_exponent || at - first_of_exponent > 3) return nullptr;
    power +=
        is_small ? -static_cast<std::ptrdiff_t>(exponent) : static_cast<std::ptrdiff_t>(exponent);
  }
  double size = 0.0;
  if (!scale_by_ten(digits, power, size)) {
    return std::from_chars(begin, at, value).ec == std::errc{} ? at : nullptr;
  }
  // Without a branch, which signs in random order would mislead.
  value =
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) | std::uint64_t{is_negative} << 63);
  return at;
}

}  // namespace loopbench
