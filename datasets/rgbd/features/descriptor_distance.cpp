#include <cmath>
#include <cstring>

#include "datasets/rgbd/features/features.hpp"

namespace loopbench::rgbd {
namespace {

/// Number of bits set, without the POPCNT instruction, which is not available on all machines.
std::uint64_t bits_set(std::uint64_t x) {
  x -= (x >> 1) & 0x5555555555555555u;
  x = (x & 0x3333333333333333u) + ((x >> 2) & 0x3333333333333333u);
  return (((x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u) >> 56;
}

}  // namespace

float descriptor_distance(const Features& a, std::size_t i, const Features& b, std::size_t k) {
  const std::uint8_t* p = a.descriptor(i);
  const std::uint8_t* q = b.descriptor(k);
  const auto bytes = static_cast<std::size_t>(a.bytes);
  if (a.binary) {
    std::uint64_t sum = 0;
    for (std::size_t at = 0; at < bytes; at += 8) {
      std::uint64_t x = 0;
      std::uint64_t y = 0;
      const std::size_t count = std::min<std::size_t>(8, bytes - at);
      std::memcpy(&x, p + at, count);
      std::memcpy(&y, q + at, count);
      sum += bits_set(x ^ y);
    }
    return static_cast<float>(sum) / static_cast<float>(8 * bytes);
  }
  int sum = 0;
  for (std::size_t at = 0; at < bytes; ++at) {
    const int difference = p[at] - q[at];
    sum += difference * difference;
  }
  return std::sqrt(static_cast<float>(sum)) / 1024.0f;  // SIFT descriptors have norm 512
}

}  // namespace loopbench::rgbd
