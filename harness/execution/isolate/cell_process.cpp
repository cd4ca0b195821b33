#include "harness/execution/isolate/cell_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "harness/execution/isolate/active_clock.hpp"
#include "harness/execution/isolate/cell_child.hpp"
#include "harness/execution/isolate/cell_output.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/isolate/signal_name.hpp"
#include "harness/execution/isolate/worker_signals.hpp"
#include "harness/execution/run/oracle_method.hpp"
#include "harness/external/external_methods.hpp"
#include "harness/external/server.hpp"

namespace loopbench::harness {
namespace {

constexpr int kMemoryTick = 20;     // [ms], between checks of memory and processes
constexpr int kMostProcesses = 64;  // of one cell, apart from threads

/// What a control group counts beyond the growth of processes: page tables, buffers, files [bytes].
constexpr std::int64_t kReserveOfGroup = std::int64_t{64} << 20;

/// The reason why a worker ends a cell.
struct Verdict {
  Status status = Status::ok;
  std::string why;
};

std::optional<Verdict> exceeded(const Limits& limits,
                                ActiveClock& clock,
                                std::int64_t at_fork,
                                const std::vector<pid_t>& servers) {
  if (limits.seconds > 0.0 && clock.seconds() > limits.seconds) {
    return Verdict{Status::timeout,
                   fmt::format("the cell exceeded the time limit of {} s", limits.seconds)};
  }
  const TreeUsage usage = descendants_usage(at_fork, kMostProcesses, servers);
  if (usage.processes > kMostProcesses) {
    return Verdict{Status::failed,
                   fmt::format("the cell started more than {} processes", kMostProcesses)};
  }
  if (limits.memory > 0 && usage.memory > limits.memory) {
    return Verdict{Status::out_of_memory,
                   fmt::format("the cell grew by {} bytes, limit {}", usage.memory, limits.memory)};
  }
  return std::nullopt;
}

/// Waits until the cell ends or exceeds a limit. `cell`: its pidfd; `sweep`: socket to the sweep.
std::optional<Verdict> watch_cell(int cell,
                                  int sweep,
                                  CellOutput& output,
                                  const Limits& limits,
                                  std::int64_t at_fork,
                                  const std::vector<pid_t>& servers) {
  ActiveClock clock;
  const double tick = limits.memory > 0 ? kMemoryTick : ActiveClock::kTick;  // [ms]
  for (;;) {
    const double left = limits.seconds > 0.0 ? 1e3 * (limits.seconds - clock.seconds()) : tick;
    pollfd events[] = {{cell, POLLIN, 0}, {output.read_end(), POLLIN, 0}, {sweep, 0, 0}};
    poll(events, std::size(events), static_cast<int>(std::clamp(left, 0.0, tick)) + 1);
    if (!output.forward()) {
      return Verdict{Status::failed,
                     fmt::format("the cell printed more than {} MiB", CellOutput::kMost >> 20)};
    }
    if ((events[0].revents & POLLIN) != 0) return std::nullopt;
    if (has_sweep_ended()) {
      return std::nullopt;
    }
    if (auto verdict = exceeded(limits, clock, at_fork, servers)) return verdict;
  }
}

}  // namespace

CellProcesses::CellProcesses(const WorkerContext& context,
                             int sweep,
                             int core,
                             const ScratchFolder* scratch,
                             const ControlGroup& group)
    : context_(context),
      sweep_(sweep),
      core_(core),
      null_(open("/dev/null", O_RDWR | O_CLOEXEC)),
      scratch_(scratch),
      group_(group) {}

CellProcesses::~CellProcesses() { close(null_); }

void CellProcesses::hide_inputs(const LoadedSequences::Entry& entry) {
  const std::vector<InputFile>& inputs = entry.metadata.inputs;
  if (!std::ranges::equal(inputs, hidden_, {}, &InputFile::path, &InputFile::path)) {
    hidden_ = inputs;
    end_servers();  // they are in the previous sandbox
  }
  program_sandbox() = context_.sandbox;
  for (const InputFile& input : inputs) program_sandbox().hidden.emplace_back(input.path);
}

std::string CellProcesses::packed_failure(const Cell& cell,
                                          Status status,
                                          const std::string& why,
                                          const std::string& signal) const {
  CellResult result;
  result.cell = cell;
  result.status = status;
  result.why = why;
  result.signal = signal;
  result.worker = {true, context_.sweep.serial, core_ >= 0};
  result.oracle_method = uses_reference(context_.sweep.methods[cell.method], context_.catalogue);
  Packer pack;
  pack(result);
  return pack.bytes();
}

std::string CellProcesses::run(const Cell& cell, const LoadedSequences::Entry& entry) {
  if (scratch_ != nullptr) hide_inputs(entry);
  area_.clear();
  CellOutput output;
  const Limits& limits = context_.sweep.limits;
  const std::int64_t memory = limits.memory > 0 ? process_memory("self") : 0;
  if (limits.memory > 0) group_.limit_growth(limits.memory + kReserveOfGroup);
  prepare_programs(context_.sweep.methods[cell.method], command_setting(context_.sweep));
  const RunningServers servers = running_servers();
  const pid_t worker = getpid();
  const pid_t process = fork_when_possible();
  if (process < 0) throw std::runtime_error(fmt::format("fork: {}", std::strerror(errno)));
  if (process == 0) {
    run_cell_and_exit({context_,
                       cell,
                       entry.sequence,
                       worker,
                       core_,
                       null_,
                       output.write_end(),
                       area_,
                       servers.descriptors});
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
      watch_cell(descriptor, sweep_, output, limits, memory, servers.processes);
  close(descriptor);
  set_running_cell(0);
  const int status = end_cell(process, servers.processes);
  end_servers(true);
  if (scratch_ != nullptr) scratch_->remove_exchanges();
  if (has_sweep_ended()) {
    end_servers();
    if (scratch_ != nullptr) scratch_->remove_with_parent();
    _exit(0);
  }
  output.forward();
  const std::int64_t ended_before = std::exchange(ended_by_limit_, group_.ended_by_limit());
  const bool ended_by_limit = ended_by_limit_ > ended_before;
  if (verdict) return packed_failure(cell, verdict->status, verdict->why, "SIGKILL");
  if (ended_by_limit) {
    return packed_failure(
        cell,
        Status::out_of_memory,
        fmt::format("the kernel killed it at its memory limit of {} bytes", limits.memory),
        "SIGKILL");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    if (const auto result = area_.read(process)) return std::string(*result);
  }
  if (!WIFSIGNALED(status)) {
    const std::string why = fmt::format("exited, exit code {}", WEXITSTATUS(status));
    return packed_failure(cell, Status::crashed, why, "");
  }
  const std::string signal = signal_name(WTERMSIG(status));
  const bool is_kill = WTERMSIG(status) == SIGKILL;
  return packed_failure(
      cell,
      Status::crashed,
      "ended by " + signal + (is_kill ? ", not by this program (system out of memory?)" : ""),
      signal);
}

}  // namespace loopbench::harness
