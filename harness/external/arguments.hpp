/// Command lines of external programs, split without a shell.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace loopbench::harness {

/// Words of a command line: separated by blanks, with '...', "..." and \x as in a POSIX shell.
/// Variables, wildcards, pipes and redirections are not interpreted. Throws OptionError with
/// `option` for an open quote, or without any word.
std::vector<std::string> split_arguments(const std::string& option, const std::string& text);

/// Replaces each "{name}" in each word; other braces are kept.
std::vector<std::string> with_values(std::vector<std::string> words,
                                     const std::map<std::string, std::string>& values);

}  // namespace loopbench::harness
