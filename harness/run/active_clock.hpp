/// Clock that counts only time in which the process was running.
#pragma once

#include <algorithm>
#include <chrono>

namespace loopbench::harness {

/// Call seconds() several times per second. A longer interval between two calls means that the
/// process was stopped (Ctrl-Z, a suspended container): only kLongestStep of it counts.
class ActiveClock {
 public:
  /// Ask at least this often [ms].
  static constexpr int kTick = 200;

  void restart() {
    last_ = Clock::now();
    total_ = 0.0;
  }
  /// Time since restart() [s].
  double seconds() {
    const auto now = Clock::now();
    total_ += std::min(std::chrono::duration<double>(now - last_).count(), kLongestStep);
    last_ = now;
    return total_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kLongestStep = 1.0;  // [s], more than any delay by a busy system

  Clock::time_point last_ = Clock::now();
  double total_ = 0.0;
};

}  // namespace loopbench::harness
