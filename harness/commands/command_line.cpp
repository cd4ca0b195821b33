#include "harness/commands/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/text/suggest.hpp"

namespace loopbench::harness {
namespace {

std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
  }
  return out;
}

std::string with_hyphens(std::string text) {
  std::ranges::replace(text, '_', '-');
  return text;
}

}  // namespace

std::vector<std::string> normalised_options(const CLI::App& app, std::vector<std::string> words) {
  const auto is_given = [&](const CLI::App* each) {
    return !words.empty() && each->get_name() == words[0];
  };
  const std::vector<const CLI::App*> given = app.get_subcommands(is_given);
  if (given.empty()) return words;
  const std::vector<std::string> known = long_options(*given.front());
  for (std::string& word : words) {
    if (!word.starts_with("--")) continue;
    const std::size_t end = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, end);
    if (std::ranges::count(known, name) > 0) continue;
    const auto same = std::ranges::find(known, with_hyphens(name), with_hyphens);
    if (same != known.end()) word.replace(0, end, *same);
  }
  return words;
}

std::string unknown_word(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  const CLI::App& command = given.empty() ? app : *given.front();
  const bool is_unexpected = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (!given.empty() && !is_unexpected) return "";
  std::vector<std::string> words = app.remaining();
  const bool is_top = !words.empty();
  if (!is_top) words = command.remaining();
  if (words.empty()) return "";

  const std::string word = words.front().substr(0, words.front().find('='));
  const bool is_option = word.starts_with('-');
  if (!is_option && !given.empty()) return "";
  std::vector<std::string> known = long_options(is_top ? app : command);
  if (!is_option) {
    for (const CLI::App* each : app.get_subcommands({})) {
      if (!each->get_group().empty()) known.push_back(each->get_name());  // not hidden
    }
  }
  const std::string kind = !is_option ? "subcommand"
                           : is_top   ? "option"
                                      : "option of " + command.get_name();
  return "loopbench: " + unknown_name(kind, word, known) +
         "\nRun with --help for more information.\n";
}

}  // namespace loopbench::harness
