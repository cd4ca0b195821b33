/// Makes text from files and command lines safe to print on a terminal.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace loopbench::harness {

/// Length of the code point at the start of a text that is not empty; 0: it is not UTF-8.
std::size_t code_point_bytes(std::string_view text);

/// Keeps newlines and UTF-8. Replaces other control characters (C0, DEL, C1) and bytes that are not
/// UTF-8 by "\x1b", so that file names and contents cannot send terminal escape sequences.
std::string printable(std::string_view text);

/// At most `most` bytes of the text, without a part of a UTF-8 character at the end.
std::string_view beginning(std::string_view text, std::size_t most);

/// The text, or its first `most` bytes (without a part of a UTF-8 character) and the number of
/// omitted ones.
std::string limited(std::string_view text, std::size_t most);

/// Replaces control characters (C0 except newline, tab and carriage return, DEL, C1 in UTF-8) by
/// '?', so that a method cannot send escape sequences to the terminal. `previous`: the byte before
/// the text, and after the call its last byte.
void make_printable(std::span<char> text, char& previous);

/// Position of the first byte that is a control character (newline, tab, other C0, DEL, C1) or not
/// UTF-8; text.size() if there is none.
std::size_t first_unprintable(std::string_view text);

}  // namespace loopbench::harness
