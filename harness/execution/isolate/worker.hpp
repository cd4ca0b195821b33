/// A worker process: has sequences loaded, runs each cell in a copy of itself, sends results. It
/// runs no code of methods, metrics, datasets or plugins, and has no threads.
#pragma once

#include <cstdint>

#include "harness/catalogue/catalogue.hpp"
#include "harness/execution/sandbox/sandbox.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

struct Job {
  std::uint64_t cell = 0;  ///< index into the sweep's list of cells
  bool only_load = false;
};

/// Header of each message, followed by `size` bytes; sent as raw memory within one program.
struct Header {
  enum class Kind : std::uint32_t {
    loaded,        ///< SequenceMetadata of a job's sequence, which was loaded for it
    cannot_load,   ///< message of an exception; ends the job
    missing_part,  ///< message: the build cannot read the sequence, which ends the sweep
    load_failed,   ///< CellResult: how loading failed otherwise; ends the job
    cannot_run,    ///< message of the system, which ends the sweep
    result,        ///< CellResult; ends the job
    only_loaded,   ///< a job with only_load is done
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
  const SandboxOptions& sandbox;
};

/// Reads jobs from `socket` and answers there until it is closed. `core`: the one that cells run
/// on, or -1. Does not throw; returns early if it cannot answer.
void run_worker(const WorkerContext& context, int socket, int core);

}  // namespace loopbench::harness
