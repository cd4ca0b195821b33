/// Files of the user, and configs that are installed with the program.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace loopbench::harness {

/// `given` if it is a file or contains a slash or a dot; otherwise the file `given`.yaml among the
/// installed configs (share/loopbench/configs next to the program's folder), if it exists.
inline std::string config_path(const std::string& given) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool is_name = given.find_first_of("/.") == std::string::npos;
  if (!is_name || fs::exists(given, error)) return given;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path prefix = program.parent_path().parent_path();
  const fs::path installed = prefix / "share/loopbench/configs" / (given + ".yaml");
  return fs::is_regular_file(installed, error) ? installed.string() : given;
}

/// loopbench/NAME in the user's folder of settings ($XDG_CONFIG_HOME, or ~/.config), whether it
/// exists or not; empty without such a folder.
inline std::filesystem::path settings_file(const std::string& name) {
  const char* settings = std::getenv("XDG_CONFIG_HOME");
  const bool has_settings = settings != nullptr && *settings == '/';
  const char* home = std::getenv("HOME");
  if (!has_settings && home == nullptr) return {};
  const std::filesystem::path folder =
      has_settings ? std::filesystem::path(settings) : std::filesystem::path(home) / ".config";
  return folder / "loopbench" / name;
}

}  // namespace loopbench::harness
