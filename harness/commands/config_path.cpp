#include "harness/commands/config_path.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace loopbench::harness {

std::string config_path(const std::string& given) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool is_name = given.find_first_of("/.") == std::string::npos;
  if (!is_name || fs::exists(given, error)) return given;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path prefix = program.parent_path().parent_path();
  const fs::path installed = prefix / "share/loopbench/configs" / (given + ".yaml");
  return fs::is_regular_file(installed, error) ? installed.string() : given;
}

std::filesystem::path settings_file(const std::string& name) {
  const char* settings = std::getenv("XDG_CONFIG_HOME");
  const bool has_settings = settings != nullptr && *settings == '/';
  const char* home = std::getenv("HOME");
  if (!has_settings && home == nullptr) return {};
  const std::filesystem::path folder =
      has_settings ? std::filesystem::path(settings) : std::filesystem::path(home) / ".config";
  return folder / "loopbench" / name;
}

}  // namespace loopbench::harness
