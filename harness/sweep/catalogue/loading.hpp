/// Progress displays of loading, and the cache folder for outputs of programs.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "datasets/images/frontend.hpp"
#include "harness/sweep/model/note_text.hpp"
#include "harness/sweep/text/print_error.hpp"
#include "harness/sweep/text/printable.hpp"
#include "harness/sweep/text/wrap.hpp"

namespace loopbench::harness {

/// "[####......] 120/415  tracking".
inline std::string loading_line(const std::string& stage, std::size_t done, std::size_t total) {
  constexpr std::size_t kBar = 20;  // [columns]
  const std::size_t filled = total == 0 ? kBar : kBar * done / total;
  return fmt::format(
      "[{:#<{}}{:.<{}}] {}/{}  {}", "", filled, "", kBar - filled, done, total, stage);
}

/// $LOOPBENCH_CACHE, otherwise $XDG_CACHE_HOME/loopbench, otherwise ~/.cache/loopbench; empty: no
/// cache.
inline std::filesystem::path cache_folder() {
  if (const char* own = std::getenv("LOOPBENCH_CACHE")) return own;
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache != '\0') return std::filesystem::path(cache) / "loopbench";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".cache" / "loopbench";
}

inline void draw_progress(const std::string& stage, std::size_t done, std::size_t total) {
  const std::size_t step = std::max<std::size_t>(1, total / 100);
  if (done % step != 0 && done != total) return;
  print_error("\r\033[K{}", loading_line(stage, done, total));
  if (done == total) print_error("\r\033[K");
  std::fflush(stderr);
}

/// Progress bar on stderr; empty unless that is a terminal.
inline rgbd::FrontendProgress loading_progress() {
  return isatty(STDERR_FILENO) == 1 ? draw_progress : rgbd::FrontendProgress();
}

/// Prints the notes of a sequence to stderr, each prefixed with `label`.
inline void print_notes(const std::string& label, const std::vector<Note>& notes) {
  std::string out;
  for (const Note& note : notes) {
    out += fmt::format("{}: {}\n", printable(label), printable(text(note)));
  }
  print_error("{}", out);
}

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
