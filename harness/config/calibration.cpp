#include "harness/config/calibration.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "datasets/core/error.hpp"

namespace loopbench {

std::map<std::string, std::vector<Setting>> read_calibration(
    const std::string& calibration,
    const std::vector<std::string>& methods,
    const std::string& config,
    std::size_t line) {
  const auto refuse = [&](const std::string& what) {
    return input_error(config, line, "calibration: " + what);
  };
  std::filesystem::path path = std::filesystem::path(config).parent_path() / calibration;
  if (!std::filesystem::is_regular_file(path)) path = calibration;
  std::ifstream in(path, std::ios::binary);
  if (!in || !std::filesystem::is_regular_file(path)) {
    throw refuse(calibration + ": no such file, beside the config or as given");
  }
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const YamlNode root = parse_yaml(text, path.string());

  std::map<std::string, std::vector<Setting>> out;
  std::string wanted;
  for (const std::string& method : methods) {
    wanted += (wanted.empty() ? "" : " or ") + method;
    const YamlNode* found = root.type == YamlNode::Type::map ? root.find(method) : nullptr;
    if (found == nullptr) continue;
    for (const auto& [name, value] : found->map) {
      if (value.type != YamlNode::Type::scalar) {
        throw input_error(path.string(), value.line, name + ": expected a number");
      }
      out[method].push_back({name, value.scalar, line, value.text});
    }
  }
  if (out.empty()) throw refuse(path.string() + " has no values for " + wanted);
  return out;
}

}  // namespace loopbench
