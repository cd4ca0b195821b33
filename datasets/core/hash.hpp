/// Hash functions for noise, independent of the order of draws.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace loopbench {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every input bit changes half of the
/// output bits on average.
inline std::uint64_t hash_combine(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b) {
  return hash_combine(a ^ hash_combine(b));
}

/// Hash of a byte string, in words of eight bytes. Not cryptographically secure.
inline std::uint64_t hash_combine(std::uint64_t seed, std::string_view bytes) {
  std::uint64_t hash = hash_combine(seed, std::uint64_t{bytes.size()});
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = std::min<std::size_t>(8, bytes.size());
    std::memcpy(&word, bytes.data(), count);
    hash = std::rotl((hash ^ word) * 0x9fb21c651e98df25u, 29);
    bytes.remove_prefix(count);
  }
  return hash_combine(hash);
}

/// Uniform draw in [0, 1) with 24 bits.
inline float uniform(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

/// Approximately normal draw of unit variance: the sum of four uniform draws, at most 3.5 in
/// absolute value. Fast and bit-identical on all platforms.
inline float approximate_normal(std::uint64_t bits) {
  const std::uint64_t sum =
      (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
  return (static_cast<float>(sum) * 0x1p-16f - 2.0f) * 1.7320508f;
}

}  // namespace loopbench
