/// Properties of standard output.
#pragma once

#include <string>

#include "harness/answers/tables/table.hpp"

namespace loopbench::harness {

/// Width of the terminal that `stream` is: from the terminal, else $COLUMNS, else 80; at least 40.
std::size_t terminal_width(int stream);

/// Whether standard output is a terminal.
bool prints_to_terminal();

/// terminal_width() of standard output and whether it shows colours:
/// not if NO_COLOR is set to any text or TERM is dumb. Without a terminal: unlimited, no colour.
TerminalStyle standard_output_style();

/// `line` broken into the width of the terminal, if standard output is one; later lines are
/// indented.
std::string fitted(const std::string& line);

/// The same in the width of the terminal, if standard error is one.
std::string fitted_error(const std::string& line);

/// fitted() of each line of `text`.
std::string fitted_lines(const std::string& text);

/// The name under which the program was called, for commands that the user can copy:
/// $LOOPBENCH_NAME (set by run.sh) or "loopbench".
std::string program_name();

}  // namespace loopbench::harness
