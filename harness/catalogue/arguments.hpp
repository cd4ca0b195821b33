/// Command lines of external programs, split without a shell.
#pragma once

#include <filesystem>
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

/// Names of the files in `folder` that determine what a command line does: existing ones among its
/// words, then all of `depends`, which are separated by blanks. Throws OptionError, and InputError
/// if a file of `depends` is missing.
std::vector<std::string> named_files(const std::string& line,
                                     const std::string& depends,
                                     const std::filesystem::path& folder);

}  // namespace loopbench::harness
