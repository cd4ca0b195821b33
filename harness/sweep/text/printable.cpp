#include "harness/sweep/text/printable.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace loopbench::harness {
namespace {

/// The same as code_point_bytes(), but 0 for a control character.
std::size_t shown_bytes(std::string_view text) {
  const char first = text[0];
  const bool is_c0 = static_cast<unsigned char>(first) < 0x20 && first != '\n';
  const bool is_c1 =
      first == '\xc2' && text.size() > 1 && (static_cast<unsigned char>(text[1]) & 0xe0u) == 0x80;
  return is_c0 || is_c1 || first == '\x7f' ? 0 : code_point_bytes(text);
}

}  // namespace

std::size_t code_point_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return std::uint32_t{static_cast<unsigned char>(text[i])};
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xc0 || first > 0xf4) return 0;
  const std::size_t size = 2 + (first >= 0xe0 ? 1 : 0) + (first >= 0xf0 ? 1 : 0);
  if (text.size() < size) return 0;
  std::uint32_t point = first & (0x7fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return 0;
    point = (point << 6) | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // code point, by length
  const bool is_surrogate = point >= 0xd800 && point < 0xe000;
  return point >= kLeast[size] && point <= 0x10ffff && !is_surrogate ? size : 0;
}

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t size = shown_bytes(text);
    if (size > 0) {
      out += text.substr(0, size);
    } else {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    }
    text.remove_prefix(size > 0 ? size : 1);
  }
  return out;
}

std::string_view beginning(std::string_view text, std::size_t most) {
  if (text.size() <= most) return text;
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80;
  };
  std::size_t kept = most;
  while (kept > 0 && most - kept < 4 && continues(kept)) --kept;
  return text.substr(0, kept);
}

std::string limited(std::string_view text, std::size_t most) {
  const std::string_view kept = beginning(text, most);
  if (kept.size() == text.size()) return std::string(text);
  return fmt::format("{} ... ({} more bytes)", kept, text.size() - kept.size());
}

void make_printable(std::span<char> text, char& previous) {
  for (char& each : text) {
    const auto byte = static_cast<unsigned char>(each);
    const bool is_space = each == '\n' || each == '\t' || each == '\r';
    const bool is_c1 = previous == '\xc2' && byte >= 0x80 && byte <= 0x9f;
    previous = each;
    if ((byte < 0x20 && !is_space) || byte == 0x7f || is_c1) each = '?';
  }
}

std::size_t first_unprintable(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size() && text[at] != '\n') {
    const std::size_t size = shown_bytes(text.substr(at));
    if (size == 0) break;
    at += size;
  }
  return at;
}

}  // namespace loopbench::harness
