#include "harness/run/watched_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "harness/base/child_process.hpp"
#include "harness/base/descendants.hpp"
#include "harness/base/printable.hpp"
#include "harness/base/system_file.hpp"
#include "harness/catalogue/server.hpp"
#include "harness/run/active_clock.hpp"
#include "harness/run/activity.hpp"
#include "harness/run/warm_heap.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryTick = 20;  // [ms], between checks of memory and processes

/// Writable memory beyond the limit that a cell may reserve without using it [bytes].
constexpr std::int64_t kReserve = std::int64_t{1} << 30;

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

CellOutput::CellOutput() {
  if (pipe2(ends_, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
  fcntl(ends_[0], F_SETFL, O_NONBLOCK);
}

CellOutput::~CellOutput() {
  close_read_end();
  close_write_end();
}

void CellOutput::close_read_end() {
  if (ends_[0] >= 0) close(ends_[0]);
  ends_[0] = -1;
}

void CellOutput::close_write_end() {
  if (ends_[1] >= 0) close(ends_[1]);
  ends_[1] = -1;
}

bool CellOutput::forward() {
  char buffer[1 << 14];
  while (total_ <= kMost && ends_[0] >= 0) {
    const ssize_t size = read(ends_[0], buffer, sizeof buffer);
    if (size < 0) break;  // nothing now
    if (size == 0) close_read_end();
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
  const TreeUsage usage = descendants_usage(at_fork, limits.processes, watched.servers);
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
  const std::optional<Verdict> verdict =
      watch({process, work.subject, work.limits, servers.processes}, sweep_, output);
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
