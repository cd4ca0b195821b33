#include "harness/config/calibration.hpp"

#include <filesystem>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"

namespace loopbench::harness {
namespace {

/// The list of strings under a key; empty without the key.
std::vector<std::string> words(const YamlNode& root, const char* key, const std::string& file) {
  const YamlNode* node = root.type == YamlNode::Type::map ? root.find(key) : nullptr;
  std::vector<std::string> out;
  if (node == nullptr) return out;
  for (const YamlNode& item : node->list) {
    if (item.type != YamlNode::Type::scalar) {
      throw input_error(file, item.line, std::string(key) + ": expected a list of strings");
    }
    out.push_back(item.text);
  }
  return out;
}

}  // namespace

CalibratedSettings read_calibration(const std::string& calibration,
                                    const std::vector<std::string>& methods,
                                    const std::string& config,
                                    std::size_t line) {
  const auto refuse = [&](const std::string& what) {
    return input_error(config, line, "calibration: " + what);
  };
  std::filesystem::path path = std::filesystem::path(config).parent_path() / calibration;
  if (!std::filesystem::is_regular_file(path)) path = calibration;
  if (!std::filesystem::is_regular_file(path)) {
    throw refuse(calibration + ": file not found, neither relative to the config nor as given");
  }
  constexpr std::size_t kLargest = std::size_t{16} << 20;  // [bytes]
  const YamlNode root = parse_yaml(read_regular_file(path, kLargest, "calibration"), path.string());

  CalibratedSettings out;
  out.trained_on = {calibration,
                    words(root, "trained_on", path.string()),
                    words(root, "trained_on_sources", path.string())};
  std::string wanted;
  for (const std::string& method : methods) {
    wanted += (wanted.empty() ? "" : " or ") + method;
    const YamlNode* found = root.type == YamlNode::Type::map ? root.find(method) : nullptr;
    if (found == nullptr) continue;
    for (const auto& [name, value] : found->map) {
      if (value.type != YamlNode::Type::scalar) {
        throw input_error(path.string(), value.line, name + ": expected a number");
      }
      out.by_method[method].push_back({name, value.scalar, line, value.text});
    }
  }
  if (out.by_method.empty()) throw refuse(path.string() + " has no values for " + wanted);
  return out;
}

}  // namespace loopbench::harness
