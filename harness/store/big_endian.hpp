/// Big-endian integers of the SQLite file format.
#pragma once

#include <cstddef>
#include <cstdint>

namespace loopbench::harness {

/// Unsigned integer of `size` bytes, at most 8.
inline std::uint64_t big_endian(const char* data, std::size_t size) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < size; ++i) out = out << 8 | static_cast<unsigned char>(data[i]);
  return out;
}

inline std::uint32_t big_endian_16(const char* data) {
  return static_cast<std::uint32_t>(big_endian(data, 2));
}
inline std::uint32_t big_endian_32(const char* data) {
  return static_cast<std::uint32_t>(big_endian(data, 4));
}

}  // namespace loopbench::harness
