#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/commands/commands.hpp"
#include "harness/commands/help.hpp"
#include "harness/commands/help_format.hpp"

namespace loopbench::harness {
namespace {

/// The words that can take the place of the last one, each with its meaning; empty where a file or
/// any other text is expected. `words` start with the program's name.
std::vector<std::pair<std::string, std::string>> candidates(const CLI::App& app,
                                                            const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    const auto children = commands_of(*command);
    const auto next = std::ranges::find(children, words[i], &CLI::App::get_name);
    if (next == children.end()) break;
    command = *next;
  }
  std::vector<std::pair<std::string, std::string>> out;
  const std::vector<const CLI::Option*> options = command->get_options();
  const std::string before = words.size() < 2 ? "" : words[words.size() - 2];
  for (const CLI::Option* option : options) {
    if (std::ranges::count(names_of(*option), before) == 0 || !has_value(*option)) continue;
    for (const std::string& choice : choices_of(*option)) out.emplace_back(choice, "");
    return out;
  }
  if (words.back().starts_with('-')) {
    for (const CLI::Option* option : options) {
      if (option->get_positional()) continue;
      for (const std::string& name : names_of(*option)) {
        out.emplace_back(name, option->get_description());
      }
    }
    return out;
  }
  const bool is_help = command->get_name() == "help";
  for (const CLI::App* each : commands_of(is_help ? app : *command)) {
    out.emplace_back(each->get_name(), each->get_description());
  }
  return out;
}

}  // namespace

void add_complete(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("complete", "Print the words that complete a command line");
  command->group("");         // only for shells, see cmake/package/completions
  command->prefix_command();  // the words are no options of this command
  command->callback([&app, command, &exit_code] {
    const std::vector<std::string> words = command->remaining();
    exit_code = kExitOk;
    if (words.empty()) return;
    for (const auto& [word, meaning] : candidates(app, words)) {
      if (word.starts_with(words.back())) fmt::print("{}\t{}\n", word, meaning);
    }
  });
}

}  // namespace loopbench::harness
