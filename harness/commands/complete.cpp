#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/commands/commands.hpp"
#include "harness/commands/help_format.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "metrics/protocols/protocols.hpp"

namespace loopbench::harness {
namespace {

using Words = std::vector<std::pair<std::string, std::string>>;

/// The names that an option with this placeholder takes; ANY is all of them.
Words known_names(const std::string& placeholder) {
  Words out;
  const auto add = [&](const auto& entries) {
    for (const auto& each : entries) out.emplace_back(each.name, each.summary);
  };
  const bool is_any = placeholder == "ANY";
  if (is_any || placeholder == "METHOD") add(catalogue({}).methods);
  if (is_any || placeholder == "METRIC") add(catalogue({}).metrics);
  if (is_any || placeholder == "PROTOCOL") add(metrics::protocols());
  return out;
}

/// The words that can take the place of the last one, each with its meaning; empty where a file or
/// any other text is expected. `words` start with the program's name.
Words candidates(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    const auto children = commands_of(*command);
    const auto next = std::ranges::find(children, words[i], &CLI::App::get_name);
    if (next == children.end()) break;
    command = *next;
  }
  Words out;
  const std::vector<const CLI::Option*> options = command->get_options();
  const std::string before = words.size() < 2 ? "" : words[words.size() - 2];
  for (const CLI::Option* option : options) {
    if (std::ranges::count(names_of(*option), before) == 0 || !has_value(*option)) continue;
    const bool is_list = option->get_delimiter() != '\0';
    if (!is_list && words.back().find(',') != std::string::npos) return {};
    for (const std::string& choice : choices_of(*option)) out.emplace_back(choice, "");
    return out.empty() ? known_names(option->get_type_name()) : out;
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
  if (command->get_name() == "list") out = known_names("ANY");
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
    std::vector<std::string> words = command->remaining();
    exit_code = kExitOk;
    if (words.empty()) return;
    // --option=value, which bash passes as three words.
    std::string option;
    if (words.back() == "=") words.back().clear();
    std::erase(words, "=");
    const std::size_t equals = words.back().find('=');
    if (words.back().starts_with("--") && equals != std::string::npos) {
      option = words.back().substr(0, equals + 1);
      words.push_back(words.back().substr(equals + 1));
      words[words.size() - 2].resize(equals);
    }
    // The last element of a list, such as evo,tum.
    const std::string before = words.back().substr(0, words.back().rfind(',') + 1);
    for (const auto& [word, meaning] : candidates(app, words)) {
      if ((before + word).starts_with(words.back()))
        fmt::print("{}{}{}\t{}\n", option, before, word, meaning);
    }
  });
}

}  // namespace loopbench::harness
