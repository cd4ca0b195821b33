/// Main loop of a worker process: loads sequences, runs cells, sends results.
#pragma once

#include <atomic>
#include <cstdint>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Status of a worker in memory shared with the sweep, which checks the time limit.
struct SharedStatus {
  static constexpr std::uint64_t kIdle = ~std::uint64_t{0};
  std::atomic<std::uint64_t> job = kIdle;  ///< Job::cell
  std::atomic<std::int64_t> since = 0;     ///< start of the job [ns], steady clock
  std::atomic<bool> loading = false;       ///< loading the sequence, before the cell itself
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

struct Job {
  std::uint64_t cell = 0;  ///< index into the sweep's list of cells
  bool only_load = false;
};

/// Header of each message, followed by `size` bytes; sent as raw memory within one program.
struct Header {
  enum class Kind : std::uint32_t {
    loaded,       ///< SequenceMetadata of a job's sequence, which was loaded for it
    cannot_load,  ///< message of the InputError, which ends the sweep
    result,       ///< CellResult
    only_loaded,  ///< a job with only_load is done
  };
  Kind kind = Kind::result;
  std::uint64_t cell = 0;
  std::uint64_t size = 0;
};

/// Data shared by all workers of a sweep; must outlive them.
struct WorkerContext {
  const Sweep& sweep;
  const std::vector<Cell>& cells;
  const Catalogue& catalogue;
  const DataRoot& root;
};

/// Reads jobs from `socket` and answers there until it is closed. `pinned`: the core to run on, or
/// -1. Does not throw; returns early if it cannot answer.
void run_worker(const WorkerContext& context, int socket, SharedStatus& shared_status, int pinned);

/// Steady clock [ns], common to all processes.
std::int64_t steady_nanoseconds();

}  // namespace loopbench::harness
