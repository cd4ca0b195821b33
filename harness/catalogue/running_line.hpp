/// What a program that runs for long is doing, on a terminal.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <utility>

#include "harness/base/print_error.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/wrap.hpp"

namespace loopbench::harness {

/// A line "running PROGRAM, 42 s: last line that it printed" on standard error, if that is a
/// terminal; the destructor clears it.
class RunningLine {
 public:
  explicit RunningLine(std::string program) : program_(std::move(program)) {}
  ~RunningLine() {
    if (drawn_ != begin_) print_error("\r\033[K");
  }
  RunningLine(const RunningLine&) = delete;
  RunningLine& operator=(const RunningLine&) = delete;

  /// Draws at most twice a second. `output`: the end of what the program has printed.
  void draw(const std::string& output) {
    const auto now = Clock::now();
    if (!is_visible_ || now - drawn_ < std::chrono::milliseconds(500)) return;
    drawn_ = now;
    const std::size_t end = output.find_last_not_of("\r\n");
    const std::size_t begin = end == std::string::npos ? end : output.find_last_of("\r\n", end);
    const std::string last =
        end == std::string::npos ? "" : ": " + output.substr(begin + 1, end - begin);
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(now - begin_).count();
    constexpr std::size_t kColumns = 79;
    print_error(
        "\r\033[K{}",
        cut(printable(fmt::format("running {}, {} s{}", program_, seconds, last)), kColumns));
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::string program_;
  bool is_visible_ = isatty(STDERR_FILENO) == 1;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_ = begin_;
};

}  // namespace loopbench::harness
