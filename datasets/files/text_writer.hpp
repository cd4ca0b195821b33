/// Text output buffered in memory. Numbers are printed in the shortest form that parses to the same
/// value.
#pragma once

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "datasets/core/error.hpp"
#include "datasets/files/replace_file.hpp"

namespace loopbench {

class TextWriter {
 public:
  /// `separator` stands between the words of a line.
  explicit TextWriter(char separator = ' ') : separator_(separator) {}

  /// Appends a `# ` line; line breaks in `text` start further comment lines.
  void comment(std::string_view text) {
    while (true) {
      const std::size_t end = text.find('\n');
      text_.append("# ").append(text.substr(0, end)).push_back('\n');
      if (end == std::string_view::npos) return;
      text.remove_prefix(end + 1);
    }
  }

  TextWriter& word(std::string_view text) {
    separate();
    text_ += text;
    return *this;
  }

  TextWriter& number(double value) {
    separate();
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text_.append(digits.data(), end);
    return *this;
  }

  TextWriter& integer(std::int64_t value) {
    separate();
    text_ += std::to_string(value);
    return *this;
  }

  void end_line() { text_ += '\n'; }

  /// Appends one line of numbers.
  void row(std::initializer_list<double> values) {
    for (const double value : values) number(value);
    end_line();
  }

  /// Writes the file; `-` is standard output. Throws InputError if it cannot be written completely.
  void save(const std::filesystem::path& file) const {
    if (file != "-") return replace_file(file, text_, Target::named);
    if (std::fwrite(text_.data(), 1, text_.size(), stdout) != text_.size()) {
      throw input_error("-", 0, std::string("cannot be written: ") + std::strerror(errno));
    }
  }

 private:
  void separate() {
    if (!text_.empty() && text_.back() != '\n') text_ += separator_;
  }

  char separator_;
  std::string text_;
};

}  // namespace loopbench
