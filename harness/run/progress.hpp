/// A progress line for people: cells, rate, time left. Only on a terminal, only on stderr.
/// Thread-safe.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace loopbench {

class Progress {
 public:
  /// Silent unless stderr is a terminal.
  explicit Progress(std::size_t total);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more cell is done; redraws at most ten times a second.
  void step(const std::string& label);

  /// A sequence is being made: so far `done` of `total` steps of `stage`.
  void loading(const std::string& stage, std::size_t done, std::size_t total);

  /// A line that stays, on stderr, terminal or not.
  void note(const std::string& text);

 private:
  bool due(bool last);
  void draw(const std::string& line);

  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  bool visible_;
  std::size_t total_;
  std::size_t done_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point drawn_{};
};

/// "[####......] 120/415  tracking", at most `width` columns.
std::string loading_line(std::size_t done,
                         std::size_t total,
                         const std::string& stage,
                         std::size_t width);

/// "[####......] 12/30  8.1 cells/s  2 s left  label", at most `width` columns.
std::string progress_line(std::size_t done,
                          std::size_t total,
                          double seconds,
                          const std::string& label,
                          std::size_t width);

}  // namespace loopbench
