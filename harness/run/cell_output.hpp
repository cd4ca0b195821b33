/// Standard output and error of a cell.
#pragma once

#include <cstdint>
#include <span>

namespace loopbench::harness {

/// Replaces control characters (C0 except newline, tab and carriage return, DEL, C1 in UTF-8) by
/// '?', so that a method cannot send escape sequences to the terminal. `previous`: the byte before
/// the text, and after the call its last byte.
void make_printable(std::span<char> text, char& previous);

/// Forwards the beginning of what a cell prints to standard error and counts the rest.
class CellOutput {
 public:
  static constexpr std::int64_t kForwarded = std::int64_t{64} << 10;  // [bytes]
  static constexpr std::int64_t kMost = std::int64_t{16} << 20;       // [bytes], more is an error

  CellOutput();  ///< throws std::runtime_error if no pipe can be created
  ~CellOutput();
  CellOutput(const CellOutput&) = delete;
  CellOutput& operator=(const CellOutput&) = delete;

  int write_end() const { return ends_[1]; }
  int read_end() const { return ends_[0]; }  ///< -1 after everybody has closed the other end
  void close_write_end();

  /// Reads what is there without waiting; false if it was more than kMost in all.
  bool forward();

 private:
  void close_read_end();

  int ends_[2] = {-1, -1};
  std::int64_t total_ = 0;
  char last_ = '\0';  ///< forwarded
};

}  // namespace loopbench::harness
