/// A text file and its lines of data: the layer every reader stands on.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/core/error.hpp"

namespace loopbench {

/// One line of data. Columns are separated by blanks, tabs or commas.
struct Line {
  std::string_view text;      ///< without line end; never blank, never a comment
  std::size_t number = 0;     ///< from 1
  bool unterminated = false;  ///< the last line of a file that does not end in a newline
};

/// Reads a file through a window that stays in the cache: no more of it is in memory than the
/// window, or its longest line. Both line ends and a UTF-8 byte order mark are accepted. Throws
/// InputError: missing, not a plain file, unreadable, empty, larger than 8 GiB, binary (holds a NUL
/// byte; a line refused before it comes first).
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& file);

  /// The next line of data, skipping blank lines and lines that start with '#'. Its text lives
  /// until the next call.
  bool next(Line& line);

  /// Puts back the line that next() gave last.
  void put_back(const Line& line);

  /// The whole file as `count` or fewer files of about one size, cut at line ends. Each counts its
  /// lines from 1.
  std::vector<TextFile> cut(std::size_t count) const;

  /// Read so far, blank ones and comments too.
  std::size_t lines() const { return line_; }

  const std::string& name() const { return name_; }
  std::size_t bytes() const { return size_; }

  /// `file:line: what`.
  InputError error(std::size_t line, const std::string& what) const {
    return input_error(name_, line, what);
  }

  /// Noted by whoever judges a line of this part.
  struct Mended {
    double off_unit = 0.0;
    std::size_t repeated = 0;
  };
  mutable Mended mended;

  /// How many lines fit if all were as long as `line`: a hint for reserve(), capped by the file.
  /// The first part counts the whole file, for what is read from the others is put behind.
  std::size_t lines_like(const Line& line) const {
    return (begin_ == 0 ? size_ : end_ - begin_) / (line.text.size() + 1) + 1;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  TextFile(const std::string& name, std::size_t size, std::size_t begin, std::size_t end);
  void refill();

  std::string name_;
  std::size_t size_ = 0;      ///< of the whole file [bytes]
  std::size_t begin_ = 0;     ///< offset in the file where this part begins
  std::size_t unread_ = 0;    ///< offset in the file of what the window will take next
  std::size_t end_ = 0;       ///< offset in the file where this part ends
  std::size_t capacity_ = 0;  ///< of the window
  std::size_t filled_ = 0;    ///< bytes in the window
  std::size_t position_ = 0;  ///< of the next line in the window
  std::size_t line_ = 0;
  std::unique_ptr<std::FILE, Close> handle_;
  std::unique_ptr<char[]> window_;
};

}  // namespace loopbench
