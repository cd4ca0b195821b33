/// Mixing of numbers: noise that depends on what it is for and not on who asks first, and keys.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace loopbench {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every input bit moves half of the output.
inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline std::uint64_t mixed(std::uint64_t a, std::uint64_t b) { return mixed(a ^ mixed(b)); }

/// A key of bytes: eight at a time, and the rest. Not safe against someone who means harm.
inline std::uint64_t mixed(std::uint64_t seed, std::string_view bytes) {
  std::uint64_t hash = mixed(seed, std::uint64_t{bytes.size()});
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = std::min<std::size_t>(8, bytes.size());
    std::memcpy(&word, bytes.data(), count);
    hash = std::rotl((hash ^ word) * 0x9fb21c651e98df25u, 29);
    bytes.remove_prefix(count);
  }
  return mixed(hash);
}

/// In [0, 1) of 24 bits.
inline float uniform(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

/// About normal, unit variance: the sum of four uniform draws (largest 3.5). Cheap and exact bits.
inline float about_normal(std::uint64_t bits) {
  const std::uint64_t sum =
      (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
  return (static_cast<float>(sum) * 0x1p-16f - 2.0f) * 1.7320508f;
}

}  // namespace loopbench
