#include "harness/store/digest.hpp"

#include <charconv>
#include <cstring>

namespace loopbench::harness {
namespace {

Hash parsed_digest(std::string_view digest) {
  Hash out;
  if (digest.size() != 32) return out;
  std::from_chars(digest.data(), digest.data() + 16, out.low, 16);
  std::from_chars(digest.data() + 16, digest.data() + 32, out.high, 16);
  return out;
}

}  // namespace

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

void SumOfDigests::add(std::string_view digest) {
  const Hash term = parsed_digest(digest);
  sum_.low += term.low;
  sum_.high += term.high;
}

void SumOfDigests::remove(std::string_view digest) {
  const Hash term = parsed_digest(digest);
  sum_.low -= term.low;
  sum_.high -= term.high;
}

}  // namespace loopbench::harness
