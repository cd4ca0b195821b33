#include "harness/commands/help_format.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "harness/commands/standard_output.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {

bool has_value(const CLI::Option& option) {
  return option.get_expected_max() != 0 && option.get_items_expected_max() != 0;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_single_name()};
  std::vector<std::string> out;
  for (const std::string& name : option.get_snames()) out.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.push_back("--" + name);
  return out;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  // The words of a set that CLI11 or one_of() append to the type: "TEXT:{a,b}", "TEXT:a|b".
  const std::string type = option.get_type_name();
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

namespace {

/// Placeholder of an option's value: the type without its range, in words; empty for a flag.
std::string placeholder(const CLI::Option& option) {
  if (!has_value(option)) return "";
  const std::string type = option.get_type_name();
  const std::string name = type.substr(0, type.find(':'));
  if (name.empty()) return "TEXT";
  if (name == "FLOAT") return "NUMBER";
  return name == "INT" || name == "UINT" ? "N" : name;
}

/// Without the brackets that CLI11 prints around lists.
std::string default_text(const std::string& text) {
  return text.starts_with('[') && text.ends_with(']') ? text.substr(1, text.size() - 2) : text;
}

constexpr std::size_t kWidest = 100;
constexpr std::size_t kLongestChoice = 40;  ///< longer ones are in the description
constexpr std::size_t kTextColumn = 26;     ///< of the descriptions

/// 0: unlimited.
std::size_t help_width() { return std::min(kWidest, standard_output_style().width); }

/// `name` indented, and `text` beside or below it.
std::string entry(const std::string& name, const std::string& text) {
  return beside("  " + name, text, kTextColumn, help_width());
}

/// Lines that begin with a space are examples and keep their form.
std::string paragraphs(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    const bool is_example = line.starts_with(' ');
    for (const std::string& part : wrapped(line, is_example ? 0 : help_width())) out += part + "\n";
  }
  return out;
}

/// `text` with the name under which the program was called, so that commands can be copied.
std::string with_program_name(std::string text) {
  const std::string name = program_name();
  constexpr std::string_view kName = "loopbench ";
  for (std::size_t at = 0; (at = text.find(kName, at)) != std::string::npos; at += name.size()) {
    text.replace(at, kName.size() - 1, name);
  }
  return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

std::string list_of_names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* each : options) names.push_back(each->get_name());
  std::ranges::sort(names);
  return joined(names, ", ");
}

/// "61 more options (Files, Pairing): loopbench eval --help-all", of a command with kDailyGroup.
std::string other_groups(const CLI::App& command) {
  std::vector<std::string> groups;
  std::size_t count = 0;
  for (const CLI::Option* option : command.get_options()) {
    const std::string& group = option->get_group();
    if (option->get_positional() || group.empty() || group == kDailyGroup || group == "Options")
      continue;
    ++count;
    if (std::ranges::count(groups, group) == 0) groups.push_back(group);
  }
  const std::string name = program_name() + " " + command.get_name();
  return std::to_string(count) + " more options (" + joined(groups, ", ") + "): " + name +
         " --help-all\n";
}

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* command,
                        std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::vector<std::string> groups = command->get_groups();
    is_brief_ = mode == CLI::AppFormatMode::Normal && std::ranges::count(groups, kDailyGroup) > 0;
    std::string out = CLI::Formatter::make_help(command, std::move(name), mode);
    // Groups that are left out leave their blank lines.
    for (std::size_t at = 0; is_brief_ && (at = out.find("\n\n\n")) != std::string::npos;) {
      out.erase(at, 1);
    }
    is_brief_ = false;
    return out;
  }
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    const std::vector<std::string> choices = choices_of(*option);
    const bool is_list = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    const std::string list = joined(choices, "|");
    const bool is_short = list.size() <= kLongestChoice;
    std::string value = choices.empty() || !is_short ? placeholder(*option) : list;
    if (is_positional && value == "TEXT") value.clear();
    const std::string name = joined(names_of(*option), ", ") + (value.empty() ? "" : " " + value) +
                             (is_list && !value.empty() ? " ..." : "");
    std::string help = option->get_description();
    if (!is_short) help += ": " + joined(choices, " | ");
    if (!option->get_envname().empty()) {
      help += " (environment variable " + option->get_envname() + ")";
    }
    const std::string given = default_text(option->get_default_str());
    if (!given.empty()) help += " (default: " + given + ")";
    if (!option->get_needs().empty())
      help += " (only with " + list_of_names(option->get_needs()) + ")";
    if (!option->get_excludes().empty())
      help += " (not with " + list_of_names(option->get_excludes()) + ")";
    return entry(name, help);
  }
  /// With one blank line between groups, not two.
  std::string make_group(std::string group,
                         bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (is_brief_ && !is_positional && group != "Options" && group != kDailyGroup) return "";
    const bool follows = !is_positional && group != "Options";
    return CLI::Formatter::make_group(group, is_positional, options).substr(follows ? 1 : 0);
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return entry(command->get_name(), command->get_description());
  }
  std::string make_description(const CLI::App* command) const override {
    return paragraphs(command->get_description());
  }
  std::string make_usage(const CLI::App* command, std::string name) const override {
    return with_program_name(CLI::Formatter::make_usage(command, std::move(name)));
  }
  std::string make_footer(const CLI::App* command) const override {
    const std::string more = is_brief_ ? other_groups(*command) + "\n" : "";
    return paragraphs(more) + paragraphs(with_program_name(command->get_footer()));
  }

 private:
  mutable bool is_brief_ = false;  ///< while the help of a command without --help-all is made
};

}  // namespace

void declare_daily(CLI::App& command, const std::vector<std::string>& names) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_positional()) option->group("Options");  // else their group is before this one
  }
  for (const std::string& name : names) command.get_option(name)->group(kDailyGroup);
  command.set_help_all_flag("--help-all", "Print all options and exit")->group("Options");
}

std::shared_ptr<CLI::FormatterBase> help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace loopbench::harness
