#include "harness/cluster/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/formats/regular_file.hpp"
#include "harness/config/bytes.hpp"

namespace loopbench::harness {
namespace {

constexpr std::size_t kLargestFile = 1'000'000;  // [bytes]; also of parse_yaml()

[[noreturn]] void reject_setting(const std::string& name,
                                 const std::string& found,
                                 const std::string& expected) {
  throw OptionError(name, name + " = " + found + ": expected " + expected);
}

void check_slurm_name(const std::string& name, const std::string& text) {
  const auto is_accepted = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_.,+:&|()[]*-").find(c) != std::string_view::npos;
  };
  if (std::ranges::all_of(text, is_accepted)) return;
  reject_setting(name, text, "letters, digits and _.,+:&|()[]*-");
}

/// Numbers between the separators; empty if a part is not a number.
std::vector<std::int64_t> numbers_between(const std::string& text, char separator) {
  std::vector<std::int64_t> out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    std::int64_t number = 0;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, number);
    const bool is_number =
        error == std::errc() && rest == text.data() + end && number >= 0 && number < 1'000'000;
    if (!is_number) return {};
    out.push_back(number);
    begin = end + 1;
  }
  return out;
}

}  // namespace

std::int64_t limit_seconds(const std::string& time) {
  constexpr std::int64_t kMinute = 60;
  constexpr std::int64_t kHour = 3600;
  constexpr std::int64_t kDay = 86400;
  if (time.empty()) return 0;
  const std::size_t dash = time.find('-');
  std::int64_t out = 0;
  bool is_valid = false;
  if (dash == std::string::npos) {
    const std::vector<std::int64_t> parts = numbers_between(time, ':');
    is_valid = !parts.empty() && parts.size() <= 3;
    if (parts.size() == 1) out = kMinute * parts[0];
    if (parts.size() == 2) out = kMinute * parts[0] + parts[1];
    if (parts.size() == 3) out = kHour * parts[0] + kMinute * parts[1] + parts[2];
  } else {
    const std::vector<std::int64_t> days = numbers_between(time.substr(0, dash), '-');
    const std::vector<std::int64_t> parts = numbers_between(time.substr(dash + 1), ':');
    is_valid = days.size() == 1 && !parts.empty() && parts.size() <= 3;
    const std::int64_t units[] = {kHour, kMinute, 1};
    if (is_valid) out = kDay * days[0];
    for (std::size_t i = 0; is_valid && i < parts.size(); ++i) out += units[i] * parts[i];
  }
  if (!is_valid || out == 0) reject_setting("time", time, "MINUTES, MM:SS, HH:MM:SS or D-HH:MM:SS");
  return out;
}

std::int64_t limit_bytes(const std::string& memory) {
  if (memory.empty()) return 0;
  const auto bytes = parse_bytes(memory);
  if (!bytes) reject_setting("memory", memory, "a size, for example 4GiB");
  return *bytes;
}

ClusterSettings with_settings(const ClusterSettings& base, const Params& given) {
  ClusterSettings out = with(base, given);
  limit_seconds(out.time);
  limit_bytes(out.memory);
  check_slurm_name("partition", out.partition);
  check_slurm_name("account", out.account);
  check_slurm_name("qos", out.qos);
  check_slurm_name("constraint", out.constraint);
  return out;
}

ClusterSettings read_cluster(const YamlNode& node, const std::string& file, ClusterSettings base) {
  if (node.type != YamlNode::Type::map) {
    throw input_error(file, node.line, "cluster: expected a map of settings, such as {array: 16}");
  }
  for (const auto& [name, value] : node.map) {
    if (value.type != YamlNode::Type::scalar) {
      throw input_error(file, value.line, "cluster: " + name + ": expected a value");
    }
    // A time or size as written, not as a number.
    const bool is_text = name == "time" || name == "memory";
    try {
      base = with_settings(base, {{name, is_text ? Param(value.text) : value.scalar}});
    } catch (const OptionError& error) {
      throw input_error(file, value.line, std::string("cluster: ") + error.what());
    }
  }
  return base;
}

ClusterSettings cluster_settings(const std::filesystem::path& config,
                                 const std::filesystem::path& user_file) {
  ClusterSettings out;
  if (!user_file.empty() && std::filesystem::exists(user_file)) {
    const std::string text = read_named_file(user_file, kLargestFile, "a YAML file");
    out = read_cluster(parse_yaml(text, user_file.string()), user_file.string(), out);
  }
  const std::string text = read_named_file(config, kLargestFile, "a YAML config");
  const YamlNode root = parse_yaml(text, config.string());
  const YamlNode* node = root.find("cluster");
  return node == nullptr ? out : read_cluster(*node, config.string(), out);
}

std::filesystem::path user_cluster_file() {
  const std::filesystem::path name = "loopbench/cluster.yaml";
  const char* const folder = std::getenv("XDG_CONFIG_HOME");
  if (folder != nullptr && *folder != '\0') return folder / name;
  const char* const home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".config" / name;
}

}  // namespace loopbench::harness
