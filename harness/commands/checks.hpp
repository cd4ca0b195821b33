/// Validators for option values that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "harness/base/suggest.hpp"

namespace loopbench::harness {

/// A number that is neither NaN nor infinite (CLI11's own ranges let NaN pass).
CLI::Validator finite_number();

/// A number in this range.
CLI::Validator number_between(double low, double high);

/// A number above zero.
CLI::Validator positive_number();

/// Adds --tie and --relevant: when methods share a place.
void declare_ties(CLI::App& command, double& tie, double& relevant);

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
