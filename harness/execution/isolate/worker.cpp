#include "harness/execution/isolate/worker.hpp"

#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>

#include "harness/execution/isolate/loaded_sequences.hpp"
#include "harness/execution/isolate/pack_result.hpp"
#include "harness/execution/run/run_cell.hpp"
#include "harness/external/external_methods.hpp"

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

bool answer(int socket, Header::Kind kind, std::uint64_t cell, const std::string& bytes) {
  const Header header{kind, cell, bytes.size()};
  return send_all(socket, &header, sizeof header) && send_all(socket, bytes.data(), bytes.size());
}

/// Pins the process to one core; false if that is not permitted.
bool pin(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(core), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

void begin(SharedStatus& shared_status, std::uint64_t job, bool loading) {
  // Store the time first: the sweep must not combine an old time with a new job.
  shared_status.since = steady_nanoseconds();
  shared_status.loading = loading;
  shared_status.job = job;
}

/// Detects a method that exceeded the limit between two checks by the sweep.
void apply_limits(const Limits& limits, CellResult& result) {
  if (limits.memory <= 0 || result.peak_memory.value_or(0) <= limits.memory) return;
  result.status = Status::out_of_memory;
  result.why = "grew to " + std::to_string(*result.peak_memory) + " bytes, limit " +
               std::to_string(limits.memory);
  result.scores.clear();
  result.trace = {};
}

}  // namespace

std::int64_t steady_nanoseconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

void run_worker(const WorkerContext& context, int socket, SharedStatus& shared_status, int pinned) {
  const Worker how{true, pinned >= 0, pinned >= 0 && pin(pinned)};
  LoadedSequences loaded(context);
  for (Job job; receive_all(socket, &job, sizeof job);) {
    const Cell& cell = context.cells[job.cell];
    const LoadedSequences::Entry* entry = loaded.find(cell);
    if (entry == nullptr) {
      begin(shared_status, job.cell, true);
      try {
        entry = &loaded.load(cell);
      } catch (const std::exception& error) {
        answer(socket, Header::Kind::cannot_load, job.cell, error.what());
        return;
      }
      Packer metadata;
      metadata(entry->metadata);
      if (!answer(socket, Header::Kind::loaded, job.cell, metadata.bytes())) return;
    }
    if (job.only_load) {
      shared_status.job = SharedStatus::kIdle;
      if (!answer(socket, Header::Kind::only_loaded, job.cell, "")) return;
      continue;
    }
    begin(shared_status, job.cell, false);
    prepare_programs(context.sweep.methods[cell.method], command_setting(context.sweep));
    CellResult result = run_cell(cell, context.sweep, entry->sequence, context.catalogue);
    result.worker = how;
    apply_limits(context.sweep.limits, result);
    shared_status.job = SharedStatus::kIdle;
    Packer packed;
    packed(result);
    if (!answer(socket, Header::Kind::result, job.cell, packed.bytes())) return;
  }
}

}  // namespace loopbench::harness
