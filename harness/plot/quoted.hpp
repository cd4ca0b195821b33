/// Texts in gnuplot scripts.
#pragma once

#include <string>

#include "harness/text/printable.hpp"

namespace loopbench::harness {

/// Single-quoted gnuplot string: quotes are doubled; line breaks are not possible in it. gnuplot
/// rejects a string that begins with a quote, so a space precedes it.
inline std::string gnuplot_quoted(const std::string& text) {
  std::string out = text.starts_with('\'') ? "' " : "'";
  for (const char c : printable(text))
    out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

}  // namespace loopbench::harness
