#include "harness/store/digest.hpp"

#include <array>
#include <cstdint>
#include <cstring>

namespace loopbench::harness {
namespace {

constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> hexadecimal_digits() {
  std::array<std::uint8_t, 256> out{};
  out.fill(kNoDigit);
  for (std::uint8_t i = 0; i < 10; ++i) out[static_cast<std::size_t>('0' + i)] = i;
  for (std::uint8_t i = 0; i < 6; ++i) {
    out[static_cast<std::size_t>('a' + i)] = static_cast<std::uint8_t>(10 + i);
  }
  return out;
}

constexpr std::array<std::uint8_t, 256> kDigits = hexadecimal_digits();

}  // namespace

Hash parsed_digest(std::string_view digest) {
  if (digest.size() != 32) return {};
  std::uint64_t parts[2] = {0, 0};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    const std::uint8_t digit = kDigits[static_cast<unsigned char>(digest[i])];
    if (digit == kNoDigit) return {};
    parts[i / 16] = parts[i / 16] << 4 | digit;
  }
  return {parts[0], parts[1]};
}

void RowsDigest::add(std::string_view row) {
  const Hash chained[2] = {state_, hash_of(row)};
  char bytes[sizeof chained];
  std::memcpy(bytes, chained, sizeof chained);
  state_ = hash_of({bytes, sizeof bytes});
  any_ = true;
}

std::string digest_of_columns(Statement& row, int from, int to) {
  RowsDigest digest;
  digest.add(row, from, to);
  return digest.text();
}

Hash digest_of_row(Statement& row, int from, int to) {
  RowsDigest digest;
  digest.add(row, from, to);
  return digest.value();
}

void SumOfDigests::add(const Hash& digest) {
  sum_.low += digest.low;
  sum_.high += digest.high;
}

void SumOfDigests::remove(std::string_view digest) {
  const Hash term = parsed_digest(digest);
  sum_.low -= term.low;
  sum_.high -= term.high;
}

}  // namespace loopbench::harness
