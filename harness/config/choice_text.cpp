#include "harness/config/choice_text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "harness/config/choices.hpp"
#include "harness/config/method_text.hpp"
#include "harness/config/source_text.hpp"
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

/// Parses a word as boolean, number or text: true, 7, 0.5 or text.
Param typed(const std::string& word) {
  if (word == "true" || word == "false") return word == "true";
  const char* const end = word.data() + word.size();
  std::int64_t whole = 0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, whole);
      error == std::errc{} && rest == end) {
    return whole;
  }
  double real = 0.0;
  if (const auto [rest, error] = std::from_chars(word.data(), end, real);
      error == std::errc{} && rest == end) {
    return real;
  }
  return word;
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

Params parse_settings(const std::vector<std::string>& settings,
                      const std::vector<OptionInfo>& options,
                      const std::string& expected) {
  Params out;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      throw InputError("--set: '" + setting + "': expected " + expected);
    }
    const std::string name = setting.substr(0, equals);
    const std::string text = setting.substr(equals + 1);
    Param value = typed(text);
    const auto option = std::ranges::find(options, name, &OptionInfo::name);
    if (option != options.end()) value = value_for(*option, value, text);
    if (const double* real = std::get_if<double>(&value); real && !std::isfinite(*real)) {
      throw InputError("--set: " + setting + ": expected a finite number");
    }
    out[name] = value;
  }
  return out;
}

}  // namespace loopbench::harness
