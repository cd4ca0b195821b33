/// Processes that a worker forks for code that may fail: limits, output, and the end of all that
/// they started.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/sweep/catalogue/scratch.hpp"
#include "harness/sweep/model/status.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/process/result_area.hpp"
#include "harness/sweep/text/printable.hpp"

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

/// What a process is doing, for the reason that its worker gives if it ends early. States a text
/// until destroyed, in memory that a worker shares with the processes it forks; does nothing before
/// share(). One at a time.
class Activity {
 public:
  /// In the worker, before it forks; further calls have no effect. Throws std::runtime_error if no
  /// memory can be mapped.
  static void share() {
    if (text_ != nullptr) return;
    constexpr int kFlags = MAP_SHARED | MAP_ANONYMOUS;
    void* memory = mmap(nullptr, sizeof(Text), PROT_READ | PROT_WRITE, kFlags, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("cannot map the memory for activities");
    text_ = new (memory) Text{};
  }

  /// Printable, since a method can have written there; "" if nothing is stated.
  static std::string current() {
    if (text_ == nullptr) return "";
    return printable({text_->bytes, std::min(text_->size, kMost)});
  }

  static void clear() {
    if (text_ != nullptr) text_->size = 0;
  }

  explicit Activity(std::string_view text) {
    if (text_ == nullptr) return;
    const std::string_view kept = beginning(text, kMost);
    std::ranges::copy(kept, text_->bytes);
    text_->size = kept.size();
  }
  ~Activity() { clear(); }
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

 private:
  static constexpr std::size_t kMost = 200;  // [bytes]

  struct Text {
    std::size_t size = 0;
    char bytes[kMost] = {};
  };

  inline static Text* text_ = nullptr;
};

/// What a process does and how reasons describe it.
struct WatchedWork {
  std::string subject;  ///< what exceeds a limit: "the cell"
  const Limits& limits;
  std::string when;                  ///< added to how it ended
  bool is_captured = true;           ///< its output is limited; otherwise it goes to standard error
  std::vector<int> kept;             ///< descriptors to keep open
  std::function<std::string()> run;  ///< in the new process; returns its result
};

/// How a process ended: with a result, or with the reason why it left none.
struct ProcessEnd {
  std::string_view result;  ///< valid until the next process
  Status status = Status::ok;
  std::string why;
  std::string signal;  ///< that ended it, for example "SIGSEGV"
};

/// Whether the other end of the socket is closed.
bool has_sweep_ended(int socket);

/// Forks one process after another; each starts as a copy of the worker, with nothing of earlier
/// ones.
class WatchedProcesses {
 public:
  /// `sweep`: socket to it; `scratch`: for programs, or null. Throws std::runtime_error without
  /// shared memory.
  WatchedProcesses(int sweep, const ScratchFolder* scratch);
  ~WatchedProcesses();
  WatchedProcesses(const WatchedProcesses&) = delete;
  WatchedProcesses& operator=(const WatchedProcesses&) = delete;

  /// Ends this process if the sweep has ended. Throws std::runtime_error if no process can be
  /// created.
  ProcessEnd run(const WatchedWork& work);

 private:
  /// In the new process.
  void prepare(const WatchedWork& work, int output) const;

  int sweep_;
  int null_;  ///< /dev/null
  const ScratchFolder* scratch_;
  ResultArea area_;
};

}  // namespace loopbench::harness
