/// Normalisation and error messages for command lines, beyond CLI11.
#pragma once

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "harness/base/suggest.hpp"

namespace loopbench::harness {

inline std::vector<std::string> long_options(const CLI::App& command) {
  std::vector<std::string> out;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
  }
  return out;
}

inline std::string with_hyphens(std::string text) {
  std::ranges::replace(text, '_', '-');
  return text;
}

/// The most similar of the options: by spelling, or those that begin with or contain the word.
inline std::vector<std::string> nearest(const std::string& word,
                                        const std::vector<std::string>& known) {
  if (const std::string best = closest(word, known); !best.empty()) return {best};
  const std::string core = word.substr(word.find_first_not_of('-'));
  std::vector<std::string> out;
  for (const std::string& each : known) {
    const std::string its_core = each.substr(2);
    const bool is_part =
        core.size() > 2 && (with_hyphens(its_core).find(with_hyphens(core)) != std::string::npos ||
                            (its_core.size() > 3 &&
                             with_hyphens(core).find(with_hyphens(its_core)) != std::string::npos));
    if (is_part) out.push_back(each);
  }
  return out;
}

/// The word that names no subcommand or option of `command`, with a suggestion; empty if `error`
/// has another cause. `name`: of the command, empty for the program.
inline std::string unknown_word(const CLI::App& command,
                                const std::string& name,
                                const CLI::ParseError& error) {
  const std::vector<std::string> words = command.remaining();
  if (words.empty() || std::ranges::count(words, "--") > 0) return "";
  const bool is_unexpected = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool lacks_subcommand =
      command.get_require_subcommand_min() > 0 && command.get_subcommands().empty();
  if (!is_unexpected && !lacks_subcommand) return "";

  const std::string word = words.front().substr(0, words.front().find('='));
  const bool is_option = word.starts_with('-');
  if (!is_option && !lacks_subcommand) return "";
  std::vector<std::string> known = is_option ? long_options(command) : std::vector<std::string>{};
  if (!is_option) {
    for (const CLI::App* each : command.get_subcommands({})) {
      if (!each->get_group().empty()) known.push_back(each->get_name());  // not hidden
    }
  }
  const std::string kind = is_option ? "option" : "subcommand";
  if (is_option) known = nearest(word, known);  // --help lists all
  return unknown_name(name.empty() ? kind : kind + " of " + name, word, known);
}

/// `words` after the program's name, with hyphens and underscores in long options replaced by the
/// declared spelling: --all-pairs and --all_pairs are equivalent. O(words * options).
inline std::vector<std::string> normalised_options(const CLI::App& app,
                                                   std::vector<std::string> words) {
  const auto is_given = [&](const CLI::App* each) {
    return !words.empty() && each->get_name() == words[0];
  };
  const std::vector<const CLI::App*> given = app.get_subcommands(is_given);
  if (given.empty()) return words;
  const std::vector<std::string> known = long_options(*given.front());
  for (std::string& word : words) {
    if (word == "--") break;  // files follow
    if (!word.starts_with("--")) continue;
    const std::size_t end = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, end);
    if (std::ranges::count(known, name) > 0) continue;
    const auto same = std::ranges::find(known, with_hyphens(name), with_hyphens);
    if (same != known.end()) word.replace(0, end, *same);
  }
  return words;
}

/// What is wrong with the command line: the word that names no subcommand or option, with a
/// suggestion, or the command and the message of CLI11.
inline std::string parse_error_text(const CLI::App& app, const CLI::ParseError& error) {
  // The first command with words left over, or the innermost one.
  const CLI::App* command = &app;
  std::string name;
  while (command->remaining().empty() && !command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += (name.empty() ? "" : " ") + command->get_name();
  }
  const std::string unknown = unknown_word(*command, name, error);
  const std::string why = (name.empty() ? "" : name + ": ") + error.what();
  return "loopbench: " + (unknown.empty() ? why : unknown) +
         "\nRun with --help for more information.\n";
}

}  // namespace loopbench::harness
