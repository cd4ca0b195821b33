/// Progress line with cells, rate and remaining time; only if stderr is a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace loopbench::harness {

class Progress {
 public:
  /// Prints nothing unless stderr is a terminal.
  explicit Progress(std::size_t total);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Counts a finished cell; redraws at most ten times a second.
  void step(const std::string& label);

 private:
  using Clock = std::chrono::steady_clock;

  bool visible_;
  std::size_t total_;
  std::size_t done_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_{};
};

/// "[####......] 12/30  8.1 cells/s  2 s left  label", at most `width` columns.
std::string progress_line(std::size_t done,
                          std::size_t total,
                          double seconds,
                          const std::string& label,
                          std::size_t width);

}  // namespace loopbench::harness
