/// A text file in memory and its lines of data: the layer every reader stands on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "datasets/core/error.hpp"

namespace loopbench {

/// One line of data. Columns are separated by blanks, tabs or commas.
struct Line {
  std::string_view text;      ///< without line end; never blank, never a comment
  std::size_t number = 0;     ///< from 1
  bool unterminated = false;  ///< the last line of a file that does not end in a newline
};

/// Reads the whole file at once; lines are views into it. Both line ends and a UTF-8 byte order
/// mark are accepted. Throws InputError: missing, not a plain file, unreadable, empty, larger than
/// 8 GiB, binary (holds a NUL byte).
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& file);

  /// The next line of data, skipping blank lines and lines that start with '#'.
  bool next(Line& line);

  void rewind();

  const std::string& name() const { return name_; }
  std::size_t bytes() const { return size_; }

  /// `file:line: what`.
  InputError error(std::size_t line, const std::string& what) const {
    return input_error(name_, line, what);
  }

  /// How many lines fit if all were as long as `line`: a hint for reserve(), capped by the file.
  std::size_t lines_like(const Line& line) const { return size_ / (line.text.size() + 1) + 1; }

 private:
  std::string name_;
  std::unique_ptr<char[]> content_;
  std::size_t size_ = 0;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
};

}  // namespace loopbench
