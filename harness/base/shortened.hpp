/// Limit on the length of texts that code of others returns or throws.
#pragma once

#include <string>
#include <string_view>

namespace loopbench::harness {

/// The text, or its first `most` bytes (without a part of a UTF-8 character) and the number of
/// omitted ones.
inline std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80;
  };
  std::size_t kept = most;
  while (kept > 0 && most - kept < 4 && continues(kept)) --kept;
  return std::string(text.substr(0, kept)) + " ... (" + std::to_string(text.size() - kept) +
         " more bytes)";
}

}  // namespace loopbench::harness
