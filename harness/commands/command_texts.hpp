/// Texts of options and commands as shown in help, manual pages and completions.
#pragma once

#include "harness/pages/command_pages.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace loopbench::harness {

CommandOption option_text_of(const CLI::Option& option);

/// `name`: of the command with its parent's, "traj crop"; empty for the program.
CommandText command_text_of(const CLI::App& command, const std::string& name);

}  // namespace loopbench::harness
