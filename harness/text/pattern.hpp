/// Regular expressions typed by people: of configs (`exclude`, `where`) and of the command line.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace re2 {
class RE2;
}

namespace loopbench {

/// A regular expression in RE2's syntax, so neither a pattern nor a text can make the program hang
/// or crash: O(text) time at fixed pattern, bounded memory; no look-ahead and no back-references.
/// Copies share the compiled expression; safe to use from several threads.
class Pattern {
 public:
  /// Throws InputError in words that follow the name of the option: `'(' is not a regular
  /// expression (missing ): ()`.
  explicit Pattern(std::string_view expression);
  /// The same; the error begins with the option's name.
  static Pattern of_option(std::string_view option, std::string_view expression);

  /// Whether it matches anywhere in the text.
  [[nodiscard]] bool is_in(std::string_view text) const;
  /// Whether it matches the text from end to end.
  [[nodiscard]] bool is_all_of(std::string_view text) const;

 private:
  std::shared_ptr<const re2::RE2> compiled_;
};

}  // namespace loopbench
