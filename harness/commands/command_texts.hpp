/// Texts of options and commands as shown in help, manual pages and completions.
#pragma once

#include "harness/pages/command_pages.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace loopbench::harness {

CommandOption option_text_of(const CLI::Option& option);

/// `is_program`: the command is the program itself and has no name.
CommandText command_text_of(const CLI::App& command, bool is_program);

}  // namespace loopbench::harness
