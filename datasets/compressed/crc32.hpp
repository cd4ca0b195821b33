/// CRC-32 of zip and MCAP (IEEE 802.3, reflected).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace loopbench {

/// O(bytes).
inline std::uint32_t crc32_of(std::string_view bytes) {
  static const auto kTable = [] {
    std::array<std::uint32_t, 256> out{};
    for (std::uint32_t i = 0; i < out.size(); ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1u) * 0xedb88320u);
      out[i] = value;
    }
    return out;
  }();
  std::uint32_t crc = 0xffffffffu;
  for (const char c : bytes)
    crc = (crc >> 8) ^ kTable[(crc ^ static_cast<unsigned char>(c)) & 255u];
  return ~crc;
}

}  // namespace loopbench
