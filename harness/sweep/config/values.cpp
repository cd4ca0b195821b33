#include "harness/sweep/config/values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "harness/sweep/text/pattern.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {
namespace {

/// The value of a scalar of this type, or null.
template <class Value>
const Value* scalar_as(const YamlNode& node) {
  return node.type == YamlNode::Type::scalar ? std::get_if<Value>(&node.scalar) : nullptr;
}

}  // namespace

std::string as_text(const YamlNode& node, const std::string& key) {
  if (node.type == YamlNode::Type::scalar) return node.text;
  throw node.error(key + ": expected a string");
}

std::vector<std::string> as_texts(const YamlNode& node, const std::string& key) {
  if (node.type != YamlNode::Type::list) return {as_text(node, key)};
  std::vector<std::string> out;
  for (const YamlNode& item : node.list) out.push_back(as_text(item, key));
  return out;
}

std::int64_t as_integer(const YamlNode& node, const std::string& key, std::int64_t most) {
  const auto* value = scalar_as<std::int64_t>(node);
  if (value != nullptr && *value >= 1 && *value <= most) return *value;
  throw node.error(fmt::format("{}: expected a whole number, 1 to {}", key, most));
}

int as_count(const YamlNode& node, const std::string& key) {
  return static_cast<int>(as_integer(node, key, 1'000'000));
}

double as_number(const YamlNode& node, const std::string& key, const Between& range) {
  const auto* integer = scalar_as<std::int64_t>(node);
  const auto* real = scalar_as<double>(node);
  if (integer == nullptr && (real == nullptr || !std::isfinite(*real))) {
    const std::string found = node.type == YamlNode::Type::scalar ? " = " + node.text : "";
    throw node.error(key + found + ": expected a number");
  }
  const double out = real != nullptr ? *real : static_cast<double>(*integer);
  if (range.holds(out)) return out;
  throw node.error(fmt::format("{} = {}: expected {}", key, to_text(out), range.text(key)));
}

bool as_flag(const YamlNode& node, const std::string& key) {
  if (const bool* value = scalar_as<bool>(node)) return *value;
  throw node.error(key + ": expected true or false");
}

std::string as_pattern(const YamlNode& node, const std::string& key) {
  const std::string text = as_text(node, key);
  try {
    Pattern{text};
  } catch (const InputError& error) {
    throw node.error(key + ": " + error.what());
  }
  return text;
}

std::int64_t as_bytes(const YamlNode& node, const std::string& key) {
  const std::string text = as_text(node, key);
  if (text == "none") return 0;
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  std::string unit(rest, end);
  while (unit.starts_with(' ')) unit.erase(0, 1);
  for (const auto& [name, factor] : {std::pair{"", 1.0},
                                     std::pair{"B", 1.0},
                                     std::pair{"kB", 1e3},
                                     std::pair{"MB", 1e6},
                                     std::pair{"GB", 1e9},
                                     std::pair{"KiB", 1024.0},
                                     std::pair{"MiB", 1048576.0},
                                     std::pair{"GiB", 1073741824.0}}) {
    const double bytes = number * factor;
    if (error == std::errc{} && unit == name && bytes >= 1.0 && bytes < 9e18) {
      return std::llround(bytes);
    }
  }
  throw node.error(key + ": expected a size (2GiB) or none");
}

void require_map(const YamlNode& node, const std::string& key, const std::string& expected) {
  if (node.type == YamlNode::Type::map) return;
  std::string found = node.type == YamlNode::Type::list ? "a list" : "nothing";
  if (node.type == YamlNode::Type::scalar) found = "'" + node.text + "'";
  throw node.error(key + ": found " + found + ", expected " + expected);
}

std::vector<InputError> unknown_keys(const YamlNode& node, const std::vector<std::string>& known) {
  std::vector<InputError> out;
  for (const auto& [key, value] : node.map) {
    if (std::ranges::count(known, key) > 0) continue;
    // Only a place for anchors, such as `common: &common {...}`.
    if (value.is_anchored && closest(key, known).empty()) continue;
    out.push_back(value.error(unknown_name("setting", key, known)));
  }
  return out;
}

void require_keys(const YamlNode& node,
                  const std::string& key,
                  const std::vector<std::string>& known) {
  require_map(node, key, fmt::format("a map of {}", fmt::join(known, ", ")));
  for (const InputError& error : unknown_keys(node, known)) throw error;
}

}  // namespace loopbench::harness
