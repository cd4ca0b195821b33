#include "harness/commands/defaults.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>

#include "datasets/formats/regular_file.hpp"
#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/suggest.hpp"
#include "harness/commands/config_path.hpp"
#include "harness/commands/help.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/config/values.hpp"

namespace loopbench::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultsName = "loopbench.yaml";
constexpr const char* kShowDefaults = "--show-defaults";

bool has_subcommands(const CLI::App& command) { return !commands_of(command).empty(); }

/// Null for words that begin with no command.
const CLI::App* command_of(const CLI::App& app, const std::vector<std::string>& words) {
  const auto is_given = [&](const CLI::App* each) {
    return !words.empty() && each->get_name() == words[0];
  };
  const std::vector<const CLI::App*> given = app.get_subcommands(is_given);
  return given.empty() ? nullptr : given.front();
}

/// The file to use; empty: none.
fs::path defaults_file(const std::vector<std::string>& words) {
  std::error_code ignored;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const fs::path path = words[i];
    if (words[i].starts_with('-') || !fs::exists(path, ignored)) continue;
    const fs::path beside = (fs::is_directory(path) ? path : path.parent_path()) / kDefaultsName;
    if (fs::is_regular_file(beside, ignored)) return beside;
    break;
  }
  const fs::path out = settings_file(kDefaultsName);
  return fs::is_regular_file(out, ignored) ? out : fs::path();
}

bool is_given(const CLI::Option& option, const std::vector<std::string>& words) {
  const std::vector<std::string> names = names_of(option);
  return std::ranges::any_of(words, [&](const std::string& word) {
    return std::ranges::count(names, word.substr(0, word.find('='))) > 0;
  });
}

bool names_files(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "FILE" || type == "DIR" || type == "PREFIX" || type == "PATH";
}

std::string key_of(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  return names.empty() ? "" : names.front();
}

/// Options that a file can set, by their first long names.
std::vector<const CLI::Option*> settable(const CLI::App& command) {
  std::vector<const CLI::Option*> out;
  for (const CLI::Option* option : command.get_options()) {
    const bool is_other = option->get_positional() || names_files(*option) ||
                          key_of(*option).empty() || key_of(*option) == "help" ||
                          "--" + key_of(*option) == kShowDefaults;
    if (!is_other) out.push_back(option);
  }
  return out;
}

const CLI::Option& option_of(const CLI::App& command, const YamlEntry& entry) {
  const auto plain = [](std::string name) {
    std::ranges::replace(name, '_', '-');
    return name;
  };
  std::vector<std::string> known;
  for (const CLI::Option* option : settable(command)) {
    for (const std::string& name : option->get_lnames()) {
      if (plain(name) == plain(entry.key)) return *option;
      known.push_back(name);
    }
  }
  throw entry.value.error(
      unknown_name("option of " + command.get_name() + " that a file can set", entry.key, known));
}

/// As YAML; empty: not given.
std::string given_values(const CLI::Option& option, const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!is_given(option, {words[i]})) continue;
    const std::size_t equals = words[i].find('=');
    if (!has_value(option)) {
      out = {"true"};
    } else if (equals != std::string::npos) {
      out.push_back(words[i].substr(equals + 1));
    } else {
      const int least = option.get_items_expected_min();
      for (int k = 0; k < std::max(1, least) && i + 1 < words.size(); ++k) {
        if (k >= least && words[i + 1].starts_with('-')) break;  // its value can be left out
        out.push_back(words[++i]);
      }
    }
  }
  const std::string text = fmt::format("{}", fmt::join(out, ", "));
  return out.size() > 1 ? "[" + text + "]" : text;
}

/// Rejects sections of no command, or of one with subcommands: their options would have no effect.
void check_sections(const CLI::App& app, const YamlNode& root) {
  std::vector<std::string> known;
  for (const CLI::App* each : commands_of(app)) {
    if (!has_subcommands(*each)) known.push_back(each->get_name());
  }
  for (const YamlEntry& entry : root.map) {
    if (std::ranges::count(known, entry.key) > 0) continue;
    throw entry.value.error(unknown_name("command with options in a file", entry.key, known));
  }
}

std::vector<std::string> words_of(const CLI::Option& option, const YamlNode& value) {
  const std::string name = names_of(option).back();
  if (!has_value(option)) {
    return as_flag(value, key_of(option)) ? std::vector<std::string>{name}
                                          : std::vector<std::string>{};
  }
  std::vector<std::string> out;
  const std::vector<YamlNode> values =
      value.type == YamlNode::Type::list ? value.list : std::vector<YamlNode>{value};
  const bool is_tuple = option.get_items_expected_min() > 1;
  if (is_tuple) out.push_back(name);
  for (const YamlNode& each : values) {
    if (each.type != YamlNode::Type::scalar)
      throw each.error(key_of(option) + ": expected a value");
    out.push_back(is_tuple ? each.text : name + "=" + each.text);
  }
  return out;
}

}  // namespace

std::vector<std::string> with_defaults(const CLI::App& app, std::vector<std::string> words) {
  const CLI::App* command = command_of(app, words);
  const fs::path file = command != nullptr ? defaults_file(words) : fs::path();
  if (file.empty()) return words;
  constexpr std::size_t kLargest = std::size_t{1} << 20;  // [bytes]
  const std::string text = read_regular_file(file, kLargest, "file");
  if (text.empty()) return words;  // as in `eval --show-defaults > loopbench.yaml`
  const YamlNode root = parse_yaml(text, file.string());
  require_map(root, kDefaultsName, "commands with their options");
  check_sections(app, root);
  const YamlNode* section = root.find(command->get_name());
  if (section == nullptr || section->type == YamlNode::Type::null) return words;
  require_map(*section, command->get_name(), "options and their values");
  std::vector<std::string> added;
  for (const YamlEntry& entry : section->map) {
    const CLI::Option& option = option_of(*command, entry);
    const std::set<CLI::Option*> others = option.get_excludes();
    const std::set<CLI::Option*> needed = option.get_needs();
    const bool is_useless =
        std::ranges::any_of(needed, [&](const auto* each) { return !is_given(*each, words); });
    const bool is_overruled =
        is_useless || is_given(option, words) ||
        std::ranges::any_of(others, [&](const auto* each) { return is_given(*each, words); });
    if (is_overruled) continue;
    for (std::string& word : words_of(option, entry.value)) added.push_back(std::move(word));
  }
  if (!added.empty()) {
    print_error("{}\n",
                printable(fmt::format(
                    "loopbench: note: {} sets {}", file.string(), fmt::join(added, " "))));
  }
  words.insert(words.begin() + 1, added.begin(), added.end());
  return words;
}

std::optional<std::string> shown_defaults(const CLI::App& app,
                                          const std::vector<std::string>& words) {
  const CLI::App* command = command_of(app, words);
  if (command == nullptr || has_subcommands(*command) ||
      std::ranges::count(words, kShowDefaults) == 0)
    return std::nullopt;
  std::string out = command->get_name() + ":\n";
  for (const CLI::Option* option : settable(*command)) {
    const std::string& value = option->get_default_str();
    const std::string given = given_values(*option, words);
    out += !given.empty() ? fmt::format("  {}: {}\n", key_of(*option), given)
           : value.empty()
               ? fmt::format("  # {}:  # {}\n", key_of(*option), option->get_description())
               : fmt::format("  # {}: {}\n", key_of(*option), value);
  }
  return out;
}

}  // namespace loopbench::harness
