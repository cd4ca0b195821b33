#include "harness/commands/config_path.hpp"

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

}  // namespace loopbench::harness
