#include "harness/sweep/run/watched_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "harness/sweep/catalogue/server.hpp"
#include "harness/sweep/process/child_process.hpp"
#include "harness/sweep/process/descendants.hpp"
#include "harness/sweep/process/sanitized.hpp"
#include "harness/sweep/process/system_file.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryTick = 20;  // [ms], between checks of memory and processes

/// Writable memory beyond the limit that a cell may reserve without using it [bytes].
constexpr std::int64_t kReserve = std::int64_t{1} << 30;

constexpr std::size_t kHugePage = std::size_t{2} << 20;  // [bytes]
constexpr int kMapped = 32 << 20;  // [bytes], larger blocks have mappings of their own

/// In a cell. Every page that a forked process touches first costs as much as microseconds of
/// computing, which would be counted as time of fast methods. Lets malloc keep the memory it gets
/// and take the next megabytes from huge pages (Linux's transparent ones, where enabled), the first
/// of which is ready afterwards. Does nothing under a sanitizer.
void warm_heap() {
#ifndef LOOPBENCH_SANITIZED
  mallopt(M_MMAP_THRESHOLD, kMapped);  // the largest value that malloc accepts
  mallopt(M_TRIM_THRESHOLD, 8 * kMapped);
  // An unused block up to the next huge page, so that the blocks after it are in huge pages.
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  const std::uintptr_t first = (end + kHugePage - 1) / kHugePage * kHugePage;
  // Volatile, so that the compiler does not leave out allocations.
  [[maybe_unused]] void* volatile const unused = std::malloc(first - end);
  void* volatile const reserve = std::malloc(kMapped - kHugePage);
  std::free(reserve);  // the heap keeps the address space
  const std::uintptr_t last = reinterpret_cast<std::uintptr_t>(sbrk(0)) / kHugePage * kHugePage;
  if (last <= first) return;  // malloc does not use this heap
  madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  *reinterpret_cast<volatile char*>(first + kHugePage / 2) = 0;  // free memory
#endif
}

/// Forwards the beginning of what a cell prints to standard error and counts the rest.
class CellOutput {
 public:
  static constexpr std::int64_t kForwarded = std::int64_t{64} << 10;  // [bytes]
  static constexpr std::int64_t kMost = std::int64_t{16} << 20;       // [bytes], more is an error

  /// Throws std::runtime_error if no pipe can be created.
  CellOutput() {
    if (pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~CellOutput() {
    close_end(0);
    close_end(1);
  }
  CellOutput(const CellOutput&) = delete;
  CellOutput& operator=(const CellOutput&) = delete;

  int write_end() const { return ends_[1]; }
  int read_end() const { return ends_[0]; }  ///< -1 after everybody has closed the other end
  void close_write_end() { close_end(1); }

  /// Reads what is there without waiting; false if it was more than kMost in all.
  bool forward() {
    char buffer[1 << 14];
    while (total_ <= kMost && ends_[0] >= 0) {
      const ssize_t size = read(ends_[0], buffer, sizeof buffer);
      if (size < 0) break;  // nothing now
      if (size == 0) close_end(0);
      const std::int64_t shown = std::clamp<std::int64_t>(kForwarded - total_, 0, size);
      if (shown > 0) {
        make_printable({buffer, static_cast<std::size_t>(shown)}, last_);
        [[maybe_unused]] const ssize_t written =
            write(STDERR_FILENO, buffer, static_cast<std::size_t>(shown));
      }
      total_ += size;
    }
    return total_ <= kMost;
  }

 private:
  void close_end(std::size_t end) {
    if (ends_[end] >= 0) close(ends_[end]);
    ends_[end] = -1;
  }

  int ends_[2] = {-1, -1};
  std::int64_t total_ = 0;
  char last_ = '\0';  ///< forwarded
};

/// The reason why a worker ends a process.
struct Verdict {
  Status status = Status::ok;
  std::string why;
};

/// A running process as it is watched.
struct Watched {
  const ChildProcess& process;
  const std::string& subject;
  const Limits& limits;
  const std::vector<pid_t>& servers;
  std::filesystem::path scratch;  ///< of programs, or empty
  ActiveClock clock = {};
};

/// Closes all descriptors but the standard streams and `kept`.
void close_all_except(std::vector<int> kept) {
  std::ranges::sort(kept);
  auto first = static_cast<unsigned>(STDERR_FILENO + 1);
  for (const int descriptor : kept) {
    const auto number = static_cast<unsigned>(descriptor);
    if (descriptor < 0 || number < first) continue;
    if (number > first) close_range(first, number - 1, 0);
    first = number + 1;
  }
  close_range(first, ~0u, 0);
}

std::optional<Verdict> exceeded(Watched& watched) {
  const Limits& limits = watched.limits;
  const std::string& subject = watched.subject;
  if (limits.seconds > 0.0 && watched.clock.seconds() > limits.seconds) {
    return Verdict{Status::timeout,
                   fmt::format("{} exceeded the time limit of {} s", subject, limits.seconds)};
  }
  // The process began as a copy of this one, which has not changed since.
  const std::int64_t at_fork = limits.memory > 0 ? process_memory("self") : 0;
  const TreeUsage usage =
      descendants_usage(at_fork, limits.processes, watched.servers, watched.scratch);
  if (usage.processes > limits.processes) {
    return Verdict{
        Status::failed,
        fmt::format("{} started more than {} processes; 'limits: {{processes: N}}' accepts more",
                    subject,
                    limits.processes)};
  }
  for (const pid_t server : watched.servers) {
    const std::int64_t memory = limits.memory > 0 ? tree_memory(server) : 0;
    if (memory <= limits.memory) continue;
    return Verdict{Status::out_of_memory,
                   fmt::format("its program grew to {} bytes, limit {}", memory, limits.memory)};
  }
  if (limits.memory > 0 && usage.memory > limits.memory) {
    return Verdict{
        Status::out_of_memory,
        fmt::format("{} grew by {} bytes, limit {}", subject, usage.memory, limits.memory)};
  }
  return std::nullopt;
}

/// Waits until the process ends or exceeds a limit. `sweep`: socket to it.
std::optional<Verdict> watch(Watched watched, int sweep, CellOutput& output) {
  const Limits& limits = watched.limits;
  const double tick = limits.memory > 0 ? kMemoryTick : ActiveClock::kTick;  // [ms]
  for (;;) {
    const double left =
        limits.seconds > 0.0 ? 1e3 * (limits.seconds - watched.clock.seconds()) : tick;
    pollfd events[] = {
        {watched.process.descriptor(), POLLIN, 0}, {output.read_end(), POLLIN, 0}, {sweep, 0, 0}};
    poll(events, std::size(events), static_cast<int>(std::clamp(left, 0.0, tick)) + 1);
    if (!output.forward()) {
      return Verdict{
          Status::failed,
          fmt::format("{} printed more than {} MiB", watched.subject, CellOutput::kMost >> 20)};
    }
    const bool has_ended = (events[0].revents & POLLIN) != 0;
    if (has_ended || (events[2].revents & (POLLHUP | POLLERR)) != 0) return std::nullopt;
    if (auto verdict = exceeded(watched)) return verdict;
  }
}

}  // namespace

bool has_sweep_ended(int socket) {
  pollfd sweep{socket, 0, 0};
  return poll(&sweep, 1, 0) > 0 && (sweep.revents & (POLLHUP | POLLERR)) != 0;
}

WatchedProcesses::WatchedProcesses(int sweep, const ScratchFolder* scratch)
    : sweep_(sweep), null_(open("/dev/null", O_RDWR | O_CLOEXEC)), scratch_(scratch) {
  Activity::share();
}

WatchedProcesses::~WatchedProcesses() { close(null_); }

void WatchedProcesses::prepare(const WatchedWork& work, int output) const {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  // If the system runs out of memory, it should kill this process, not the worker or the sweep.
  write_system_file("/proc/self/oom_score_adj", "800");
  // Ends growth that is faster than the worker's checks.
  if (work.limits.memory > 0) limit_data_memory(work.limits.memory + kReserve);
  warm_heap();
  const int target = work.is_captured ? output : STDERR_FILENO;
  dup2(null_, STDIN_FILENO);
  dup2(target, STDOUT_FILENO);
  dup2(target, STDERR_FILENO);
  close_all_except(work.kept);
}

ProcessEnd WatchedProcesses::run(const WatchedWork& work) {
  area_.clear();
  Activity::clear();
  CellOutput output;
  const RunningServers servers = running_servers();
  ChildProcess process(ProcessGroup::own, [&] {
    prepare(work, output.write_end());
    return area_.write(work.run()) ? 0 : 1;
  });
  const pid_t id = process.id();
  output.close_write_end();
  const std::filesystem::path scratch = scratch_ == nullptr ? "" : scratch_->path();
  const std::optional<Verdict> verdict =
      watch({process, work.subject, work.limits, servers.processes, scratch}, sweep_, output);
  const int status = process.end();
  end_servers(true);
  end_strays(running_servers().processes);  // what ended programs leave is not the next cell's
  if (scratch_ != nullptr) scratch_->remove_exchanges();
  if (has_sweep_ended(sweep_)) {
    end_servers();
    if (scratch_ != nullptr) scratch_->remove_with_parent();
    _exit(0);
  }
  output.forward();
  const std::string activity = Activity::current();
  const std::string in = activity.empty() ? "" : " in " + activity;
  if (verdict) return {{}, verdict->status, verdict->why + in, "SIGKILL"};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    if (const auto result = area_.read(id)) return {*result, Status::ok, "", ""};
  }
  if (WIFEXITED(status)) {
    const std::string why =
        fmt::format("exited, exit code {}{}", WEXITSTATUS(status), in + work.when);
    return {{}, Status::crashed, why, ""};
  }
  const std::string signal = signal_name(WTERMSIG(status));
  const bool is_kill = WTERMSIG(status) == SIGKILL;
  return {{},
          Status::crashed,
          "ended by " + signal + in + work.when +
              (is_kill ? ", not by this program (system out of memory?)" : ""),
          signal};
}

}  // namespace loopbench::harness
