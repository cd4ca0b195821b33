#include <fmt/format.h>

#include "harness/config/choices.hpp"
#include "harness/config/method_text.hpp"
#include "harness/config/yaml.hpp"
#include "harness/correct/correct.hpp"

namespace loopbench::harness {
namespace {

constexpr const char* kWhere = "--method";

/// Splits at `separator` outside quotes.
std::vector<std::string> split_unquoted(const std::string& text, char separator) {
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

std::string trimmed(const std::string& text) { return split_stages(text).front(); }

YamlNode scalar(const std::string& text) {
  YamlNode out = parse_yaml(text, kWhere);
  if (out.type != YamlNode::Type::scalar) {
    throw InputError(
        fmt::format("{}: found value '{}', expected one number or word", kWhere, text));
  }
  out.line = 0;
  return out;
}

}  // namespace

MethodChoice parse_method(const std::string& text, const Catalogue& catalogue) {
  YamlNode entry;
  entry.type = YamlNode::Type::map;
  std::string stages;
  for (const std::string& stage : split_unquoted(text, '+')) {
    const std::size_t colon = std::min(stage.find(':'), stage.size());
    const std::string name = trimmed(stage.substr(0, colon));
    stages += (stages.empty() ? "" : " + ") + name;
    if (colon == stage.size()) continue;
    for (const std::string& option : split_unquoted(stage.substr(colon + 1), ',')) {
      const std::size_t equals = option.find('=');
      if (equals == std::string::npos) {
        throw InputError(
            fmt::format("{}: found '{}', expected NAME:option=value,option=value", kWhere, option));
      }
      entry.map.push_back(
          {name + "." + trimmed(option.substr(0, equals)), scalar(option.substr(equals + 1))});
    }
  }
  entry.map.push_back({"method", scalar_node(stages)});
  entry.map.push_back({"label", scalar_node(text)});
  return method_choices(entry, kWhere, catalogue).front();
}

}  // namespace loopbench::harness
