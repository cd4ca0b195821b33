#include "harness/config/choice_text.hpp"

#include <fmt/format.h>

#include "harness/config/choices.hpp"
#include "harness/config/method_text.hpp"
#include "harness/config/yaml.hpp"

namespace loopbench::harness {
namespace {

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

YamlNode scalar(const std::string& text, const std::string& where) {
  YamlNode out = parse_yaml(text, where);
  if (out.type != YamlNode::Type::scalar) {
    throw InputError(fmt::format("{}: found value '{}', expected one number or word", where, text));
  }
  out.line = 0;
  return out;
}

/// Adds the options of NAME:option=value,option=value to `entry`, after the name of the stage if
/// `has_stages`. Returns the name.
std::string add_options(const std::string& text,
                        const std::string& where,
                        bool has_stages,
                        YamlNode& entry) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string name = trimmed(text.substr(0, colon));
  if (colon == text.size()) return name;
  for (const std::string& option : split_unquoted(text.substr(colon + 1), ',')) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos) {
      throw InputError(
          fmt::format("{}: found '{}', expected NAME:option=value,option=value", where, option));
    }
    const std::string key = trimmed(option.substr(0, equals));
    entry.map.push_back(
        {has_stages ? name + "." + key : key, scalar(option.substr(equals + 1), where)});
  }
  return name;
}

}  // namespace

MethodChoice parse_method(const std::string& text, const Catalogue& catalogue) {
  constexpr const char* kWhere = "--method";
  YamlNode entry;
  entry.type = YamlNode::Type::map;
  std::string stages;
  for (const std::string& stage : split_unquoted(text, '+')) {
    const std::string name = add_options(stage, kWhere, true, entry);
    stages += (stages.empty() ? "" : " + ") + name;
  }
  entry.map.push_back({"method", scalar_node(stages)});
  entry.map.push_back({"label", scalar_node(text)});
  return method_choices(entry, kWhere, catalogue).front();
}

MetricChoice parse_metric(const std::string& text,
                          const Catalogue& catalogue,
                          const std::vector<metrics::NamedProtocol>& protocols) {
  constexpr const char* kWhere = "--metric";
  YamlNode entry;
  entry.type = YamlNode::Type::map;
  const std::string name = add_options(text, kWhere, false, entry);
  entry.map.push_back({"metric", scalar_node(name)});
  entry.map.push_back({"label", scalar_node(text)});
  return metric_choices(entry, kWhere, catalogue, protocols).front();
}

}  // namespace loopbench::harness
