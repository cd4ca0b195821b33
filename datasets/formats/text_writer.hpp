/// Text put together in memory and written at once, numbers by shortest round trip.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace loopbench {

class TextWriter {
 public:
  /// A `# ` line; line breaks inside `text` begin further comment lines.
  void comment(std::string_view text);

  TextWriter& word(std::string_view text);
  TextWriter& number(double value);
  TextWriter& integer(std::int64_t value);
  void end_line();

  /// One line of numbers.
  void row(std::initializer_list<double> values);

  /// Throws InputError when the file cannot be written whole.
  void save(const std::filesystem::path& file) const;

 private:
  void separate();

  std::string text_;
};

}  // namespace loopbench
