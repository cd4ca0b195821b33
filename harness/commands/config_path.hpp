/// Files of the user, and configs that are installed with the program.
#pragma once

#include <filesystem>
#include <string>

namespace loopbench::harness {

/// `given` if it is a file or contains a slash or a dot; otherwise the file `given`.yaml among the
/// installed configs (share/loopbench/configs next to the program's folder), if it exists.
std::string config_path(const std::string& given);

/// loopbench/NAME in the user's folder of settings ($XDG_CONFIG_HOME, or ~/.config), whether it
/// exists or not; empty without such a folder.
std::filesystem::path settings_file(const std::string& name);

}  // namespace loopbench::harness
