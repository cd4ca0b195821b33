/// Normalisation and error messages for command lines, beyond CLI11.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace loopbench::harness {

/// `words` after the program's name, with hyphens and underscores in long options replaced by the
/// declared spelling: --all-pairs and --all_pairs are equivalent. O(words * options).
std::vector<std::string> normalised_options(const CLI::App& app, std::vector<std::string> words);

/// What is wrong with the command line: the word that names no subcommand or option, with a
/// suggestion, or the command and the message of CLI11.
std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error);

}  // namespace loopbench::harness
