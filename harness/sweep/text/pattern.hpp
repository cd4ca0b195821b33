/// Regular expressions in configs (`exclude`, `where`) and on the command line.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace re2 {
class RE2;
}

namespace loopbench::harness {

/// A regular expression in RE2's syntax: O(text) time for a fixed pattern and bounded memory for
/// any input; no look-ahead and no back-references. Copies share the compiled expression.
/// Thread-safe.
class Pattern {
 public:
  /// Throws InputError with a message to be appended to the name of the option: `'(' is not a
  /// regular expression (missing ): ()`.
  explicit Pattern(std::string_view expression);
  /// The same; the message begins with the option's name.
  static Pattern of_option(std::string_view option, std::string_view expression);

  /// Whether it matches anywhere in the text.
  [[nodiscard]] bool matches_part(std::string_view text) const;
  /// Whether it matches the complete text.
  [[nodiscard]] bool matches(std::string_view text) const;
  /// What the groups match if it matches the complete text; empty texts for unused groups.
  [[nodiscard]] std::optional<std::vector<std::string>> groups(std::string_view text) const;
  /// The text with all matches replaced; \1 is the first group.
  [[nodiscard]] std::string replaced(std::string text, std::string_view replacement) const;

 private:
  std::shared_ptr<const re2::RE2> compiled_;
};

}  // namespace loopbench::harness
