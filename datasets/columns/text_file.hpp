/// Line-by-line input of text files, used by all readers.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/columns/reading.hpp"
#include "datasets/compressed/input_file.hpp"
#include "datasets/core/error.hpp"

namespace loopbench {

/// One line of data. Columns are separated by blanks, tabs or commas.
struct Line {
  std::string_view text;      ///< without line ending; not blank and not a comment
  std::size_t number = 0;     ///< starts at 1
  bool unterminated = false;  ///< the last line of a file that does not end in a newline
};

/// A row without a valid pose: `drop_invalid` leaves it out.
class InvalidRow : public InputError {
 public:
  explicit InvalidRow(const InputError& error) : InputError(error) {}
};

/// Reads a file through a small window, which grows to the longest line. Unix and Windows line
/// endings and a UTF-8 byte order mark are accepted, and files as open_input() accepts them. Throws
/// InputError like open_input(), for a line of more than 1 MiB, and for a file that is binary
/// (contains a NUL byte, which is detected when the window reaches it). Parts that threads read
/// next to each other share no cache line.
class alignas(64) TextFile {
 public:
  explicit TextFile(const std::filesystem::path& file);

  /// Reads the next line of data, skipping blank lines and lines that start with '#'. Returns false
  /// at the end of the file. line.text is valid until the next call.
  bool next(Line& line);

  /// Puts back the last line returned by next().
  void put_back(const Line& line);

  /// Skips the first line of data if it names columns: three or more words with letters, none a
  /// number, followed by a line that starts with a number or has four. Words can be quoted, the
  /// first name can be empty. Only before the first call of next().
  void skip_header();

  /// The line skipped by skip_header(); empty: none.
  const std::string& header() const { return header_; }

  /// The last comment above the first line of data, without '#', found by skip_header().
  const std::string& comment() const { return comment_; }

  /// The comments `#%KEY value` above the first line of data, with their lines and without `#%`,
  /// found by skip_header().
  const std::vector<std::pair<std::size_t, std::string>>& settings() const { return settings_; }

  /// The same file from its start, or after the header if that was skipped.
  TextFile reopened() const { return part(begin_, end_); }

  /// Splits the file at line endings into at most `count` parts of similar size. Each part counts
  /// its lines from 1.
  std::vector<TextFile> cut(std::size_t count) const;

  /// Number of lines read, including blank lines and comments.
  std::size_t lines() const { return line_; }

  const std::string& name() const { return file_.name; }
  std::size_t bytes() const { return file_.size; }

  /// Error `file:line: what`.
  InputError error(std::size_t line, const std::string& what) const {
    return input_error(file_.name, line, what);
  }

  mutable ReadFindings repaired;  ///< of this part

  /// Whether numbers are short enough for short_number(): until it has failed for some of this
  /// part, after which trying it first would only take time.
  bool has_short_numbers() const { return long_numbers_ < kManyLongNumbers; }
  void count_long_number() const { ++long_numbers_; }

  /// Estimated number of lines, assuming that all are as long as `line`; a hint for reserve(). The
  /// first part counts the complete file, because the results of other parts are appended to it.
  std::size_t estimated_lines(const Line& line) const {
    return (is_first_ ? file_.size : end_ - begin_) / (line.text.size() + 1) + 1;
  }

 private:
  static constexpr int kManyLongNumbers = 32;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  TextFile(OpenedFile file, std::size_t begin, std::size_t end);
  TextFile part(std::size_t begin, std::size_t end) const;
  std::size_t offset() const { return unread_ - filled_ + position_; }  ///< of the next line
  void refill();

  OpenedFile file_;
  std::string header_;
  std::string comment_;
  std::vector<std::pair<std::size_t, std::string>> settings_;
  bool keeps_comment_ = false;
  bool is_first_ = true;      ///< the part with the first line of data
  std::size_t begin_ = 0;     ///< file offset of the first line of this part after the header
  std::size_t unread_ = 0;    ///< file offset of the next bytes to read into the window
  std::size_t end_ = 0;       ///< file offset of the end of this part
  std::size_t capacity_ = 0;  ///< of the window [bytes]
  std::size_t filled_ = 0;    ///< bytes in the window
  std::size_t position_ = 0;  ///< of the next line in the window
  std::size_t line_ = 0;
  mutable int long_numbers_ = 0;
  std::unique_ptr<std::FILE, Close> handle_;
  std::unique_ptr<char[]> window_;
};

/// Returns the first line of data without consuming it. Throws InputError if there is none.
Line first_line(TextFile& file);

}  // namespace loopbench
