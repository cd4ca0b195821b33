#include "harness/store/digest.hpp"

#include <cstring>

namespace loopbench::harness {
namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

}  // namespace

Hash parsed_digest(std::string_view digest) {
  if (digest.size() != 32) return {};
  std::uint64_t parts[2] = {0, 0};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    const int digit = hexadecimal(digest[i]);
    if (digit < 0) return {};
    parts[i / 16] = parts[i / 16] << 4 | static_cast<std::uint64_t>(digit);
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
