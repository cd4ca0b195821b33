/// Text for command lines.
#pragma once

#include <string>
#include <string_view>

namespace loopbench::harness {

/// `text` as one word of a POSIX shell: unchanged if it has no special characters, otherwise in
/// single quotes.
inline std::string shell_quoted(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace loopbench::harness
