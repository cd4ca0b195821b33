/// Defaults of options from a file: loopbench.yaml.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace loopbench::harness {

/// `words` after the program's name, with the options of the command's section in loopbench.yaml
/// inserted after the command. The file is the one beside the first file or folder among the
/// words, or ~/.config/loopbench/loopbench.yaml. Options that the words state, exclude, or
/// make useless are left out; a note on standard error lists those that are inserted. Throws
/// InputError for an unknown option, and for options that name files: a file beside foreign data
/// must not choose what is written or loaded.
std::vector<std::string> with_defaults(const CLI::App& app, std::vector<std::string> words);

/// If the words contain --show-defaults: the options of a command as a section of loopbench.yaml.
/// Those that the words do not state are comments, with their defaults if they have any.
std::optional<std::string> shown_defaults(const CLI::App& app,
                                          const std::vector<std::string>& words);

}  // namespace loopbench::harness
