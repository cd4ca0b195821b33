/// Command lines of external programs, split without a shell.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "datasets/core/error.hpp"
#include "datasets/core/params.hpp"

namespace loopbench::harness {

/// Words of a command line: separated by blanks, with '...', "..." and \x as in a POSIX shell.
/// Variables, wildcards, pipes and redirections are not interpreted. Throws OptionError with
/// `option` for an open quote, or without any word.
inline std::vector<std::string> split_arguments(const std::string& option,
                                                const std::string& text) {
  std::vector<std::string> out;
  bool in_word = false;
  char quote = '\0';
  const auto add = [&](char c) {
    if (!in_word) out.emplace_back();
    in_word = true;
    out.back() += c;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == '\0' && (c == ' ' || c == '\t' || c == '\n')) {
      in_word = false;
    } else if (c == quote) {
      quote = '\0';
    } else if (quote == '\0' && (c == '\'' || c == '"')) {
      if (!in_word) out.emplace_back();  // '' is an empty word
      in_word = true;
      quote = c;
    } else if (c == '\\' && quote != '\'' && i + 1 < text.size()) {
      add(text[++i]);
    } else {
      add(c);
    }
  }
  if (quote != '\0') {
    throw OptionError(option, option + ": the quote " + quote + " is not closed in: " + text);
  }
  if (out.empty()) throw OptionError(option, option + ": is empty, expected a program");
  return out;
}

/// Replaces each "{name}" in each word; other braces are kept.
inline std::vector<std::string> with_values(std::vector<std::string> words,
                                            const std::map<std::string, std::string>& values) {
  for (std::string& word : words) {
    std::string replaced;
    for (std::size_t i = 0; i < word.size();) {
      const std::size_t end = word[i] == '{' ? word.find('}', i) : std::string::npos;
      const auto value =
          end == std::string::npos ? values.end() : values.find(word.substr(i + 1, end - i - 1));
      if (value == values.end()) {
        replaced += word[i++];
      } else {
        replaced += value->second;
        i = end + 1;
      }
    }
    word = std::move(replaced);
  }
  return words;
}

/// Names of the files in `folder` that determine what a command line does: existing ones among its
/// words, then all of `depends`, which are separated by blanks. Throws OptionError, and InputError
/// if a file of `depends` is missing.
inline std::vector<std::string> named_files(const std::string& line,
                                            const std::string& depends,
                                            const std::filesystem::path& folder) {
  std::vector<std::string> out;
  const auto is_file = [&](const std::string& name) {
    std::error_code none;
    return std::filesystem::is_regular_file(folder / name, none);  // absolute names stay absolute
  };
  for (const std::string& word : split_arguments("run", line)) {
    if (is_file(word)) out.push_back(word);
  }
  if (depends.empty()) return out;
  for (const std::string& name : split_arguments("depends", depends)) {
    if (!is_file(name)) {
      throw InputError("depends: " + (folder / name).string() + ": is not a file");
    }
    out.push_back(name);
  }
  return out;
}

}  // namespace loopbench::harness
