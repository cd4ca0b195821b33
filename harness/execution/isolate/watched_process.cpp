#include "harness/execution/isolate/watched_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <vector>

#include "harness/execution/isolate/active_clock.hpp"
#include "harness/execution/isolate/cell_output.hpp"
#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/isolate/signal_name.hpp"
#include "harness/execution/isolate/worker_signals.hpp"
#include "harness/external/server.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryTick = 20;     // [ms], between checks of memory and processes
constexpr int kMostProcesses = 64;  // of one process, apart from threads

/// The reason why a worker ends a process.
struct Verdict {
  Status status = Status::ok;
  std::string why;
};

/// A running process as it is watched.
struct Watched {
  const std::string& subject;
  const Limits& limits;
  std::int64_t at_fork = 0;  ///< memory of the worker [bytes]
  const std::vector<pid_t>& servers;
  ActiveClock clock = {};
};

std::optional<Verdict> exceeded(Watched& watched) {
  const Limits& limits = watched.limits;
  const std::string& subject = watched.subject;
  if (limits.seconds > 0.0 && watched.clock.seconds() > limits.seconds) {
    return Verdict{Status::timeout,
                   fmt::format("{} exceeded the time limit of {} s", subject, limits.seconds)};
  }
  const TreeUsage usage = descendants_usage(watched.at_fork, kMostProcesses, watched.servers);
  if (usage.processes > kMostProcesses) {
    return Verdict{Status::failed,
                   fmt::format("{} started more than {} processes", subject, kMostProcesses)};
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

/// Waits until the process ends or exceeds a limit. `process`: its pidfd; `sweep`: socket to it.
std::optional<Verdict> watch(int process, int sweep, CellOutput& output, Watched watched) {
  const Limits& limits = watched.limits;
  const double tick = limits.memory > 0 ? kMemoryTick : ActiveClock::kTick;  // [ms]
  for (;;) {
    const double left =
        limits.seconds > 0.0 ? 1e3 * (limits.seconds - watched.clock.seconds()) : tick;
    pollfd events[] = {{process, POLLIN, 0}, {output.read_end(), POLLIN, 0}, {sweep, 0, 0}};
    poll(events, std::size(events), static_cast<int>(std::clamp(left, 0.0, tick)) + 1);
    if (!output.forward()) {
      return Verdict{
          Status::failed,
          fmt::format("{} printed more than {} MiB", watched.subject, CellOutput::kMost >> 20)};
    }
    if ((events[0].revents & POLLIN) != 0 || has_sweep_ended()) return std::nullopt;
    if (auto verdict = exceeded(watched)) return verdict;
  }
}

}  // namespace

ProcessEnd WatchedProcesses::run(const std::string& subject,
                                 const std::string& when,
                                 const ProcessWork& work) {
  area_.clear();
  CellOutput output;
  const std::int64_t memory = limits_.memory > 0 ? process_memory("self") : 0;
  const RunningServers servers = running_servers();
  const pid_t process = fork_when_possible();
  if (process < 0) throw std::runtime_error(fmt::format("fork: {}", std::strerror(errno)));
  if (process == 0) {
    work(area_, output.write_end());
    _exit(1);
  }
  setpgid(process, process);  // both processes do it, so that it is done for both
  set_running_cell(process);
  output.close_write_end();
  const int descriptor = process_descriptor(process);
  if (descriptor < 0) {
    end_cell(process, servers.processes);
    throw std::runtime_error(fmt::format("pidfd_open: {}", std::strerror(errno)));
  }
  const std::optional<Verdict> verdict =
      watch(descriptor, sweep_, output, {subject, limits_, memory, servers.processes});
  close(descriptor);
  set_running_cell(0);
  const int status = end_cell(process, servers.processes);
  end_servers(true);
  end_strays(running_servers().processes);  // what ended programs leave is not the next cell's
  if (scratch_ != nullptr) scratch_->remove_exchanges();
  if (has_sweep_ended()) {
    end_servers();
    if (scratch_ != nullptr) scratch_->remove_with_parent();
    _exit(0);
  }
  output.forward();
  if (verdict) return {{}, verdict->status, verdict->why, "SIGKILL"};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    if (const auto result = area_.read(process)) return {*result, Status::ok, "", ""};
  }
  if (!WIFSIGNALED(status)) {
    return {
        {}, Status::crashed, fmt::format("exited, exit code {}{}", WEXITSTATUS(status), when), ""};
  }
  const std::string signal = signal_name(WTERMSIG(status));
  const bool is_kill = WTERMSIG(status) == SIGKILL;
  return {{},
          Status::crashed,
          "ended by " + signal + when +
              (is_kill ? ", not by this program (system out of memory?)" : ""),
          signal};
}

}  // namespace loopbench::harness
