#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "harness/commands/commands.hpp"
#include "harness/commands/help.hpp"
#include "harness/pages/command_pages.hpp"
#include "harness/provenance/version.hpp"
#include "harness/text/write_file.hpp"

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

CommandOption option_of(const CLI::Option& option) {
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
  if (!is_flag) out.value = type.substr(0, type.find(':'));
  if (!is_flag && out.value.empty()) out.value = "TEXT";
  out.choices = choice_words(type);
  out.help = option.get_description();
  if (!option.get_envname().empty())
    out.help += " (environment variable " + option.get_envname() + ")";
  out.usual = option.get_default_str();
  return out;
}

CommandText text_of(const CLI::App& command, bool is_program) {
  CommandText out{
      is_program ? "" : command.get_name(), command.get_description(), {}, command.get_footer()};
  for (const CLI::Option* option : command.get_options()) out.options.push_back(option_of(*option));
  return out;
}

}  // namespace

void add_pages(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("pages", "Write manual pages and shell completions");
  command->group("");  // only for the build
  command->add_option("folder", *folder, "Output folder")->required();
  command->callback([&app, folder, &exit_code] {
    CommandTexts all{text_of(app, true)};
    for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
      if (!each->get_group().empty()) all.push_back(text_of(*each, false));
    }
    for (const auto& [name, text] : command_pages(all, kVersion)) {
      write_file(std::filesystem::path(*folder) / name, text);
    }
    exit_code = kExitOk;
  });
}

}  // namespace loopbench::harness
