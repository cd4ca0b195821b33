/// Memory sizes as text.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace loopbench::harness {

/// Parses "2GiB", "1.5 GiB", "500MB" or "4096" into bytes (at least one); nullopt for anything
/// else. KiB, MiB, GiB are powers of 1024; kB, MB, GB of 1000.
inline std::optional<std::int64_t> parse_bytes(const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{}) return std::nullopt;
  std::string unit(rest, end);
  while (unit.starts_with(' ')) unit.erase(0, 1);
  for (const auto& [name, factor] : {std::pair{"", 1.0},
                                     std::pair{"B", 1.0},
                                     std::pair{"kB", 1e3},
                                     std::pair{"MB", 1e6},
                                     std::pair{"GB", 1e9},
                                     std::pair{"KiB", 1024.0},
                                     std::pair{"MiB", 1048576.0},
                                     std::pair{"GiB", 1073741824.0}}) {
    const double bytes = number * factor;
    if (unit == name && bytes >= 1.0 && bytes < 9e18) {
      return static_cast<std::int64_t>(std::llround(bytes));
    }
  }
  return std::nullopt;
}

}  // namespace loopbench::harness
