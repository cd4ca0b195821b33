#include "harness/config/setting_reader.hpp"

#include "harness/text/pattern.hpp"
#include "harness/text/suggest.hpp"

namespace loopbench::harness {

void SettingReader::collect(const std::string& error) const {
  if (std::ranges::count(errors_, error) > 0) return;  // an alias repeats it
  errors_.push_back(error);
  if (errors_.size() == kMostErrors) {
    report_errors("\n" + file_ + ": reading stopped after ten errors");
  }
}

void SettingReader::report_errors(const std::string& end) const {
  if (errors_.empty()) return;
  std::string all;
  for (const std::string& error : errors_) all += (all.empty() ? "" : "\n") + error;
  throw CollectedErrors{all + end};
}

void SettingReader::map_of(const YamlNode& node,
                           const std::string& key,
                           const std::vector<std::string>& known) const {
  if (node.type != YamlNode::Type::map) {
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    const std::string found = node.type == YamlNode::Type::scalar ? "'" + node.text + "'"
                              : node.type == YamlNode::Type::list ? "a list"
                                                                  : "nothing";
    throw input_error(file_, node.line, key + ": found " + found + ", expected a map of " + all);
  }
  only_keys(node, known);
}

void SettingReader::only_keys(const YamlNode& node, const std::vector<std::string>& known) const {
  for (const YamlEntry& entry : node.map) {
    if (std::ranges::count(known, entry.key) > 0) continue;
    // Only a place for anchors, such as `common: &common {...}`.
    if (entry.value.is_anchored && closest(entry.key, known).empty()) continue;
    attempt([&] {
      throw input_error(file_, entry.value.line, unknown_name("setting", entry.key, known));
    });
  }
}

std::string SettingReader::word(const YamlNode& node, const std::string& key) const {
  if (node.type == YamlNode::Type::scalar) return node.text;
  throw input_error(file_, node.line, key + ": expected a string");
}

std::vector<std::string> SettingReader::words(const YamlNode& node, const std::string& key) const {
  if (node.type != YamlNode::Type::list) return {word(node, key)};
  std::vector<std::string> out;
  for (const YamlNode& item : node.list) out.push_back(word(item, key));
  return out;
}

std::int64_t SettingReader::integer(const YamlNode& node,
                                    const std::string& key,
                                    std::int64_t most) const {
  const auto* value = std::get_if<std::int64_t>(&node.scalar);
  if (node.type == YamlNode::Type::scalar && value != nullptr && *value >= 1 && *value <= most) {
    return *value;
  }
  throw input_error(
      file_, node.line, key + ": expected a whole number, 1 to " + std::to_string(most));
}

int SettingReader::count(const YamlNode& node, const std::string& key) const {
  return static_cast<int>(integer(node, key, 1'000'000));
}

double SettingReader::number(const YamlNode& node,
                             const std::string& key,
                             const std::string& expected,
                             const Between& rule) const {
  double out = 0.0;
  try {
    if (node.type != YamlNode::Type::scalar) throw OptionError(key, key + ": expected " + expected);
    FieldType<double>::assign(key, out, node.scalar);
    detail::check_rule(key, out, rule);
  } catch (const OptionError& error) {
    throw input_error(file_, node.line, error.what());
  }
  return out;
}

bool SettingReader::flag(const YamlNode& node, const std::string& key) const {
  const bool* value = std::get_if<bool>(&node.scalar);
  if (node.type == YamlNode::Type::scalar && value != nullptr) return *value;
  throw input_error(file_, node.line, key + ": expected true or false");
}

std::string SettingReader::pattern(const YamlNode& node, const std::string& key) const {
  const std::string text = word(node, key);
  try {
    Pattern{text};
  } catch (const InputError& error) {
    throw input_error(file_, node.line, key + ": " + error.what());
  }
  return text;
}

}  // namespace loopbench::harness
