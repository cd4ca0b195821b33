/// Main loop of a worker process: loads sequences, runs each cell in a copy of itself, sends
/// results.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>

#include "harness/catalogue/catalogue.hpp"
#include "harness/execution/sandbox/sandbox.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Status of a worker in memory shared with the sweep, which limits loading. Cells do not have it.
struct SharedStatus {
  static constexpr std::uint64_t kIdle = ~std::uint64_t{0};
  std::atomic<std::uint64_t> job = kIdle;  ///< Job::cell
  std::atomic<bool> loading = false;       ///< loading the sequence, before the cell itself
  std::atomic<std::int64_t> memory = 0;    ///< of the worker when it began to load [bytes]
  std::atomic<std::uint64_t> step = 0;     ///< number of changes
  std::atomic<std::uint64_t> sent = 0;     ///< by the worker, at least what it has sent [bytes]
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
    cannot_run,   ///< message of the system, which ends the sweep
    result,       ///< CellResult
    only_loaded,  ///< a job with only_load is done
  };
  Kind kind = Kind::result;
  std::uint64_t cell = 0;
  std::uint64_t size = 0;

  static constexpr std::uint64_t kMost = std::uint64_t{1} << 30;  ///< of `size` [bytes]

  bool is_valid() const { return kind <= Kind::only_loaded && size <= kMost; }
};

/// Data shared by all workers of a sweep; must outlive them.
struct WorkerContext {
  const Sweep& sweep;
  const std::vector<Cell>& cells;
  const Catalogue& catalogue;
  const DataRoot& root;
  const SandboxOptions& sandbox;
};

/// Reads jobs from `socket` and answers there until it is closed. `core`: the one that cells run
/// on, or -1; `group`: of this process. Does not throw; returns early if it cannot answer.
void run_worker(const WorkerContext& context,
                int socket,
                SharedStatus& shared_status,
                int core,
                const ControlGroup& group);

}  // namespace loopbench::harness
