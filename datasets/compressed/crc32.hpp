/// CRC-32 of zip and MCAP (IEEE 802.3, reflected).
#pragma once

#include <cstdint>
#include <string_view>

namespace loopbench {

/// O(bytes).
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace loopbench
