/// Declares single options and validates their values.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "harness/commands/output_files.hpp"
#include "harness/sweep/text/suggest.hpp"

namespace loopbench::harness {

/// A number that is neither NaN nor infinite (CLI11's own ranges let NaN pass).
CLI::Validator finite_number();

/// A number in this range.
CLI::Validator number_between(double low, double high);

/// A number above zero.
CLI::Validator positive_number();

/// Accepts the words of an enum, which the help lists and shells complete. `option` names it in the
/// OptionError that other words throw, as in configs.
template <NamedEnum Enum>
CLI::Validator words_of(const std::string& option) {
  std::string all;
  for (const auto& [name, value] : choices(Enum{}))
    all += (all.empty() ? "" : "|") + std::string(name);
  const auto translate = [option](std::string& text) {
    Enum value{};
    FieldType<Enum>::assign(option, value, text);
    text = std::to_string(static_cast<int>(value));  // CLI11 parses enums as numbers
    return std::string();
  };
  return CLI::Validator(translate, all);
}

template <class Value>
inline constexpr bool kIsEnum = NamedEnum<Value>;
template <class Value>
inline constexpr bool kIsEnum<std::optional<Value>> = NamedEnum<Value>;

/// Declares an option. `spelling`: its names and the placeholder of its value, "-o,--out FILE".
/// Words of an enum are named by the first long name in errors.
template <class Value>
CLI::Option* add(CLI::App& command,
                 const std::string& spelling,
                 Value& value,
                 const std::string& help) {
  const std::size_t end = std::min(spelling.find(' '), spelling.size());
  CLI::Option* out = command.add_option(spelling.substr(0, end), value, help);
  if (end < spelling.size()) out->type_name(spelling.substr(end + 1));
  if constexpr (kIsEnum<Value>) {
    using Enum = std::remove_cvref_t<decltype(*std::optional(value))>;
    out->type_name("WORD")->transform(words_of<Enum>(out->get_lnames().front()));
  }
  return out;
}

/// Adds the store of a sweep, as first argument.
template <class Path>
void declare_store(CLI::App& command, Path& store) {
  reads(command, add(command, "store", store, "Folder of results, or its results.sqlite"))
      ->required();
}

/// Adds the config of a sweep, as first argument.
inline void declare_config(CLI::App& command, std::string& config) {
  const char* const help = "YAML file, or the name of an installed config: quickstart";
  reads(command, add(command, "config", config, help))->required();
}

/// Accepts one of these words and maps it to its enumerator; `kind` names the set in messages.
template <class Enum>
CLI::Validator one_of(const std::string& kind, const std::map<std::string, Enum>& words) {
  std::vector<std::string> known;
  std::string all;
  for (const auto& [word, value] : words) {
    known.push_back(word);
    all += (all.empty() ? "" : "|") + word;
  }
  const auto translate = [kind, words, known](std::string& text) {
    const auto found = words.find(text);
    if (found == words.end()) return unknown_name(kind, text, known);
    text = std::to_string(static_cast<int>(found->second));  // CLI11 parses enums as numbers
    return std::string();
  };
  return CLI::Validator(translate, all);
}

}  // namespace loopbench::harness
