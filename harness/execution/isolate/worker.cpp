#include "harness/execution/isolate/worker.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

#include "datasets/core/parallel.hpp"
#include "harness/execution/isolate/cell_process.hpp"
#include "harness/execution/isolate/loaded_sequences.hpp"
#include "harness/execution/isolate/pack_result.hpp"
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

  bool send(Header::Kind kind, std::uint64_t cell, const std::string& bytes) const {
    const Header header{kind, cell, bytes.size()};
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

template <class T>
std::string packed(const T& value) {
  Packer pack;
  pack(value);
  return pack.bytes();
}

CellResult result_of(const LoadedSequences::Failure& failure) {
  CellResult out;
  out.status = failure.status;
  out.why = failure.why;
  out.signal = failure.signal;
  return out;
}

/// Answers one job; false if the sweep has closed the socket.
bool work(const Job& job,
          const Cell& cell,
          LoadedSequences& loaded,
          CellProcesses& cell_processes,
          const Answers& answers) {
  const LoadedSequences::Entry* entry = loaded.find(cell);
  if (entry == nullptr) {
    const auto outcome = loaded.load(cell);
    if (const auto* failure = std::get_if<LoadedSequences::Failure>(&outcome)) {
      using Kind = LoadedSequences::Failure::Kind;
      if (failure->kind != Kind::ended) {
        const bool lacks_part = failure->kind == Kind::missing_part;
        return answers.send(lacks_part ? Header::Kind::missing_part : Header::Kind::cannot_load,
                            job.cell,
                            failure->why);
      }
      return answers.send(Header::Kind::load_failed, job.cell, packed(result_of(*failure)));
    }
    entry = std::get<const LoadedSequences::Entry*>(outcome);
    if (!answers.send(Header::Kind::loaded, job.cell, packed(entry->metadata))) return false;
  }
  if (job.only_load) return answers.send(Header::Kind::only_loaded, job.cell, "");
  return answers.send(Header::Kind::result, job.cell, cell_processes.run(cell, *entry));
}

}  // namespace

void run_worker(const WorkerContext& context, int socket, int core) {
  install_worker_signals(socket);
  keep_heap_compact();
  hardware_threads();  // asks the system once for all cells
  std::optional<Programs> programs;
  if (uses_programs(context.sweep)) programs.emplace();
  const Answers answers{socket};
  const ScratchFolder* scratch = programs ? &programs->scratch : nullptr;
  WatchedProcesses processes(context.sweep.limits, socket, scratch);
  LoadedSequences loaded(context, processes);
  CellProcesses cell_processes(context, core, processes);
  for (Job job; receive_all(socket, &job, sizeof job);) {
    try {
      if (!work(job, context.cells[job.cell], loaded, cell_processes, answers)) return;
    } catch (const std::exception& error) {
      answers.send(Header::Kind::cannot_run, job.cell, error.what());
      return;
    }
  }
}

}  // namespace loopbench::harness
