/// Text output buffered in memory. Numbers are printed in the shortest form that parses to the same
/// value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace loopbench {

class TextWriter {
 public:
  /// `separator` stands between the words of a line.
  explicit TextWriter(char separator = ' ') : separator_(separator) {}

  /// Appends a `# ` line; line breaks in `text` start further comment lines.
  void comment(std::string_view text);

  TextWriter& word(std::string_view text);
  TextWriter& number(double value);
  TextWriter& integer(std::int64_t value);
  void end_line();

  /// Appends one line of numbers.
  void row(std::initializer_list<double> values);

  /// Writes the file; `-` is standard output. Throws InputError if it cannot be written completely.
  void save(const std::filesystem::path& file) const;

 private:
  void separate();

  char separator_;
  std::string text_;
};

}  // namespace loopbench
