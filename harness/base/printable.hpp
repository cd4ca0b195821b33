/// Makes text from files and command lines safe to print on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace loopbench::harness {

/// Keeps newlines and UTF-8. Replaces other control characters (C0, DEL, C1) and bytes that are not
/// UTF-8 by "\x1b", so that file names and contents cannot send terminal escape sequences.
std::string printable(std::string_view text);

/// Position of the first byte that is a control character (newline, tab, other C0, DEL, C1) or not
/// UTF-8; text.size() if there is none.
std::size_t first_unprintable(std::string_view text);

}  // namespace loopbench::harness
