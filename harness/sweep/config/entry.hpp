/// Entries of a config's lists, and the same in one word of the command line.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "harness/sweep/config/grid.hpp"
#include "harness/sweep/config/values.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {

/// A name, an optional label and options; a grid of options has several points, at least one.
struct ConfigEntry {
  Place place;
  std::string name;
  std::string label;  ///< empty: none
  std::vector<GridPoint> points;
};

/// Splits at `separator` outside quotes.
inline std::vector<std::string> split_unquoted(const std::string& text, char separator) {
  std::vector<std::string> out(1);
  char quote = '\0';
  for (const char c : text) {
    if (quote == '\0' && c == separator) {
      out.emplace_back();
      continue;
    }
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
    out.back() += c;
  }
  return out;
}

inline std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Reads `NAME`, or a map with `key: NAME`, `label: TEXT` and options. Keys in `reserved` are no
/// options. Throws InputError `file:line:`.
inline ConfigEntry read_entry(const YamlNode& node,
                              const std::string& key,
                              const std::vector<std::string>& reserved = {}) {
  if (node.type == YamlNode::Type::scalar) return {node, node.text, "", {GridPoint{}}};
  const YamlNode* name = node.find(key);
  if (name == nullptr || name->type != YamlNode::Type::scalar) {
    std::string hint;
    for (const YamlEntry& entry : node.map) {
      if (closest(key, {entry.key}).empty()) continue;
      hint = ", found '" + entry.key + "'; did you mean '" + key + "'?";
    }
    throw node.error("expected a name or a map with '" + key + ": NAME'" + hint);
  }
  ConfigEntry out{node, name->text, "", {}};
  read_key(node, "label", out.label, as_text);
  if (out.label.find_first_of("\t\n\r") != std::string::npos) {  // they part entries of lists
    throw node.find("label")->error("label: has a tab or a line break, expected one line of text");
  }
  std::vector<std::string> others = reserved;
  others.insert(others.end(), {key, "label"});
  out.points = expand(node, others);
  return out;
}

/// Parses `option=value`.
inline Setting parse_setting(const std::string& text, const std::string& where) {
  const Place place(where);
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw place.error("found '" + text + "', expected OPTION=VALUE");
  const std::string value = text.substr(equals + 1);
  const YamlNode node = parse_yaml(value, where);
  if (node.type != YamlNode::Type::scalar) {
    throw place.error("found value '" + value + "', expected one number or word");
  }
  return {trimmed(text.substr(0, equals)), node.scalar, place, node.text};
}

/// Parses `NAME:option=value,option=value`, whose label is the complete text. Stages are separated
/// by `+`; in a text with several, the name of an option starts with that of its stage. Values can
/// be quoted. `where` is the option of the command line. Throws InputError.
inline ConfigEntry parse_entry(const std::string& text, const std::string& where) {
  ConfigEntry out{Place(where), "", text, {GridPoint{}}};
  const std::vector<std::string> stages = split_unquoted(text, '+');
  for (const std::string& stage : stages) {
    const std::size_t colon = std::min(stage.find(':'), stage.size());
    const std::string name = trimmed(stage.substr(0, colon));
    out.name += (out.name.empty() ? "" : " + ") + name;
    if (colon == stage.size()) continue;
    for (const std::string& option : split_unquoted(stage.substr(colon + 1), ',')) {
      if (option.find('=') == std::string::npos) {
        throw out.place.error("found '" + option + "', expected NAME:option=value,option=value");
      }
      Setting setting = parse_setting(option, where);
      if (stages.size() > 1) setting.name = name + "." + setting.name;
      out.points.front().settings.push_back(std::move(setting));
    }
  }
  reject_repeats(out.points.front());
  return out;
}

/// Replaces the values of text options by the scalars as written: `label: 00`, `estimate: 007`,
/// `name: 1e3`. The option check reports unknown names.
inline void restore_text_options(std::vector<Setting>& settings,
                                 const std::vector<OptionInfo>& options) {
  for (Setting& setting : settings) {
    const auto option = std::ranges::find(options, setting.name, &OptionInfo::name);
    const bool is_text = option != options.end() && option->is_text && !setting.text.empty();
    if (is_text) setting.value = setting.text;
  }
}

inline Params to_params(const std::vector<Setting>& settings) {
  Params out;
  for (const Setting& setting : settings) out[setting.name] = setting.value;
  return out;
}

/// A setting of the command line.
struct GivenSetting {
  std::string text;              ///< NAME=VALUE
  std::string option = "--set";  ///< that states it
};

/// The values of settings, whose names and ranges are checked by whoever applies them. Throws
/// InputError, also if two of them have the same name.
inline Params parse_settings(const std::vector<GivenSetting>& given,
                             const std::vector<OptionInfo>& options) {
  std::vector<Setting> out;
  for (const GivenSetting& each : given) {
    Setting setting = parse_setting(each.text, each.option);
    const double* const real = std::get_if<double>(&setting.value);
    if (real != nullptr && !std::isfinite(*real)) {
      throw setting.place.error(each.text + ": expected a finite number");
    }
    const auto before = std::ranges::find(out, setting.name, &Setting::name);
    if (before != out.end()) {
      throw InputError(setting.name + ": is set to " + to_text(before->value) + " by " +
                       *before->place.file + " and to " + to_text(setting.value) + " by " +
                       each.option);
    }
    out.push_back(std::move(setting));
  }
  restore_text_options(out, options);
  return to_params(out);
}

/// The names between the plus signs of "uniform + dm_n4", trimmed.
inline std::vector<std::string> split_stages(const std::string& text) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t plus = 0; plus != std::string::npos; begin = plus + 1) {
    plus = text.find('+', begin);
    out.push_back(trimmed(text.substr(begin, plus - begin)));
  }
  return out;
}

}  // namespace loopbench::harness
