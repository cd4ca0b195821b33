#include "harness/execution/isolate/worker.hpp"

#include <malloc.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <optional>

#include "harness/execution/isolate/cell_process.hpp"
#include "harness/execution/isolate/loaded_sequences.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/isolate/process_state.hpp"
#include "harness/execution/isolate/process_tree.hpp"
#include "harness/execution/isolate/warm_heap.hpp"
#include "harness/execution/isolate/worker_signals.hpp"
#include "harness/external/external_methods.hpp"
#include "harness/external/scratch.hpp"
#include "harness/external/server.hpp"

namespace loopbench::harness {
namespace {

/// Writes all bytes; false if the other side has closed.
bool send_all(int socket, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = recv(socket, at, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Messages to the sweep.
struct Answers {
  int socket;
  SharedStatus& shared_status;

  bool send(Header::Kind kind, std::uint64_t cell, const std::string& bytes) const {
    const Header header{kind, cell, bytes.size()};
    shared_status.sent += sizeof header + bytes.size();
    return send_all(socket, &header, sizeof header) && send_all(socket, bytes.data(), bytes.size());
  }
};

/// Temporary files of programs. Programs end before their files are removed.
struct Programs {
  ScratchFolder scratch;
  Programs() = default;
  ~Programs() {
    end_servers();
    if (has_sweep_ended()) scratch.remove_with_parent();
  }
  Programs(const Programs&) = delete;
  Programs& operator=(const Programs&) = delete;
};

void set_status(SharedStatus& shared_status, std::uint64_t job, bool loading) {
  shared_status.job = job;
  shared_status.loading = loading;
  ++shared_status.step;
}

/// While it loads, the worker ends with the sweep; while a cell runs, it ends the cell first.
const LoadedSequences::Entry& load(LoadedSequences& loaded,
                                   const Cell& cell,
                                   const SandboxOptions& sandbox) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const LoadedSequences::Entry& out = [&]() -> const LoadedSequences::Entry& {
    const ProcessState state;
    program_sandbox() = sandbox;
    return loaded.load(cell);
  }();
  prctl(PR_SET_PDEATHSIG, 0);
  malloc_trim(0);  // fewer pages to copy for each cell, and none that hide its growth
  return out;
}

}  // namespace

void run_worker(const WorkerContext& context,
                int socket,
                SharedStatus& shared_status,
                int core,
                const ControlGroup& group) {
  install_worker_signals(socket);
  keep_heap_compact();
  std::optional<Programs> programs;
  if (uses_programs(context.sweep)) programs.emplace();
  const Answers answers{socket, shared_status};
  LoadedSequences loaded(context);
  const ScratchFolder* scratch = programs ? &programs->scratch : nullptr;
  CellProcesses cell_processes(context, socket, core, scratch, group);
  for (Job job; receive_all(socket, &job, sizeof job);) {
    const Cell& cell = context.cells[job.cell];
    const LoadedSequences::Entry* entry = loaded.find(cell);
    if (entry == nullptr) {
      if (context.sweep.limits.memory > 0) shared_status.memory = process_memory("self");
      set_status(shared_status, job.cell, true);
      group.remove_limit();
      try {
        entry = &load(loaded, cell, context.sandbox);
      } catch (const std::exception& error) {
        set_status(shared_status, SharedStatus::kIdle, false);
        if (!answers.send(Header::Kind::cannot_load, job.cell, error.what())) return;
        continue;
      }
      Packer metadata;
      metadata(entry->metadata);
      if (!answers.send(Header::Kind::loaded, job.cell, metadata.bytes())) return;
    }
    if (job.only_load) {
      set_status(shared_status, SharedStatus::kIdle, false);
      if (!answers.send(Header::Kind::only_loaded, job.cell, "")) return;
      continue;
    }
    set_status(shared_status, job.cell, false);
    std::string result;
    try {
      result = cell_processes.run(cell, *entry);
    } catch (const std::exception& error) {
      answers.send(Header::Kind::cannot_run, job.cell, error.what());
      return;
    }
    set_status(shared_status, SharedStatus::kIdle, false);
    if (!answers.send(Header::Kind::result, job.cell, result)) return;
  }
}

}  // namespace loopbench::harness
