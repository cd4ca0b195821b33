#include "harness/commands/command_texts.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

namespace loopbench::harness {
namespace {

/// The words of a set that CLI11 or one_of() append to the type: "TEXT:{a,b}", "TEXT:a|b".
std::vector<std::string> choice_words(const std::string& type) {
  const std::size_t colon = type.find(':');
  if (colon == std::string::npos) return {};
  std::string text = type.substr(colon + 1);
  const bool has_braces = text.starts_with('{') && text.ends_with('}');
  if (has_braces) text = text.substr(1, text.size() - 2);
  if (!has_braces && text.find('|') == std::string::npos) return {};
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, has_braces ? ',' : '|');) out.push_back(word);
  const auto is_word = [](const std::string& word) {
    return !word.empty() && word.find_first_of(" '\"()[]") == std::string::npos;
  };
  return std::ranges::all_of(out, is_word) ? out : std::vector<std::string>{};
}

/// Placeholder of a value: the type without its range, in words.
std::string placeholder(const std::string& type) {
  const std::string name = type.substr(0, type.find(':'));
  if (name.empty()) return "TEXT";
  if (name == "FLOAT") return "NUMBER";
  return name == "INT" || name == "UINT" ? "N" : name;
}

/// Without the brackets that CLI11 prints around lists.
std::string default_text(const std::string& text) {
  const bool is_list = text.starts_with('[') && text.ends_with(']');
  return is_list ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

CommandOption option_text_of(const CLI::Option& option) {
  CommandOption out;
  out.is_argument = option.get_positional();
  out.is_required = option.get_required();
  if (out.is_argument) {
    out.names = {option.get_single_name()};
  } else {
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  }
  const bool is_flag = option.get_expected_max() == 0 || option.get_items_expected_max() == 0;
  const std::string type = option.get_type_name();
  if (!is_flag) out.value = placeholder(type);
  out.choices = choice_words(type);
  out.help = option.get_description();
  if (!option.get_envname().empty())
    out.help += " (environment variable " + option.get_envname() + ")";
  out.usual = default_text(option.get_default_str());
  return out;
}

CommandText command_text_of(const CLI::App& command, const std::string& name) {
  CommandText out{name, command.get_description(), {}, command.get_footer()};
  for (const CLI::Option* option : command.get_options()) {
    out.options.push_back(option_text_of(*option));
  }
  return out;
}

}  // namespace loopbench::harness
