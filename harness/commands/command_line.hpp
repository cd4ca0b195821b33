/// Command lines as people type them, beyond what CLI11 understands.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace loopbench {

/// `words` after the program's name, with hyphens and underscores in long options of the subcommand
/// as they were declared: --all-pairs and --all_pairs are one. O(words * options).
std::vector<std::string> spelt_as_declared(const CLI::App& app, std::vector<std::string> words);

/// The word of the command line that names no subcommand or option, and what may have been meant;
/// empty when `error` is about something else.
std::string unknown_word(const CLI::App& app, const CLI::ParseError& error);

}  // namespace loopbench
