/// Layout of `--help`, and what it says about options.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class FormatterBase;
class Option;
}  // namespace CLI

namespace loopbench::harness {

/// Fits the width of the terminal, at most 100 columns; unlimited in pipes and files. Commands
/// added after it is set use it, too.
std::shared_ptr<CLI::FormatterBase> help_formatter();

/// With hyphens, short ones first; or the name of a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// Whether a value follows its name.
bool has_value(const CLI::Option& option);

/// The accepted words, if the value is one of a few.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace loopbench::harness
