/// A worker process: has sequences loaded, runs each cell in a copy of itself, sends results. It
/// runs no code of methods, metrics, datasets or plugins, and has no threads.
#pragma once

#include <cstdint>
#include <string>

#include "datasets/core/pack.hpp"
#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/model/cells.hpp"
#include "harness/sweep/model/status.hpp"
#include "harness/sweep/model/sweep.hpp"
#include "harness/sweep/process/sandbox.hpp"

namespace loopbench::harness {

struct Job {
  std::uint64_t cell = 0;  ///< index into the sweep's list of cells
  bool only_load = false;
};

/// Why a job has no result.
struct Failure {
  enum class Kind : std::uint8_t {
    cell,          ///< its process ended without a result
    loading,       ///< the process that loaded its sequence did, or memory was exhausted
    input_error,   ///< loading threw an exception with the message `why`
    missing_part,  ///< this build cannot read the sequence, which ends the sweep
    system         ///< no process can be created, which ends the sweep
  };
  Kind kind = Kind::cell;
  Status status = Status::failed;
  std::string why;
  std::string signal;  ///< that ended the process, for example "SIGSEGV"
};

template <class Archive, Either<Failure> T>
void walk(Archive& a, T& failure) {
  a(failure.kind)(failure.status)(failure.why)(failure.signal);
}

/// Header of each message, followed by `size` bytes; sent as raw memory within one program.
struct Header {
  enum class Kind : std::uint32_t {
    loaded,       ///< SequenceMetadata of the job's sequence, which was loaded for it
    only_loaded,  ///< nothing; ends a job with only_load
    result,       ///< CellResult; ends the job
    failure,      ///< Failure; ends the job
  };
  Kind kind = Kind::result;
  std::uint64_t size = 0;
};

/// Data shared by all workers of a sweep; must outlive them.
struct WorkerContext {
  const Sweep& sweep;
  const std::vector<Cell>& cells;
  const Catalogue& catalogue;
  const DataRoot& root;
  const SandboxOptions& sandbox;
  bool is_alone = false;  ///< no two cells run at the same time; set by run_isolated()
};

/// Reads jobs from `socket` and answers there until it is closed. `core`: the one that cells run
/// on, or -1. Does not throw; returns early if it cannot answer.
void run_worker(const WorkerContext& context, int socket, int core);

}  // namespace loopbench::harness
