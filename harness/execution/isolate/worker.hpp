/// The other side of the fork: loads, runs, answers, until told to end.
#pragma once

#include <atomic>
#include <cstdint>

#include "harness/catalogue/catalogue.hpp"
#include "harness/model/cells.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench {

/// What a worker is doing, in memory shared with the sweep, which watches the clock.
struct Board {
  static constexpr std::uint64_t kIdle = ~std::uint64_t{0};
  std::atomic<std::uint64_t> job = kIdle;  ///< Job::cell
  std::atomic<std::int64_t> since = 0;     ///< when that began [ns], steady clock
  std::atomic<bool> loading = false;       ///< its sequence, before the cell itself
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

struct Job {
  std::uint64_t cell = 0;  ///< index into the sweep's list of cells
  bool only_load = false;
};

/// Before each message; `size` bytes follow. All from the same program, so as they lie in memory.
struct Header {
  enum class Kind : std::uint32_t {
    loaded,       ///< SequenceFacts of a job's sequence, loaded for it
    cannot_load,  ///< the InputError's text: the sweep cannot go on
    result,       ///< CellResult
    only_loaded,  ///< a job with only_load is done
  };
  Kind kind = Kind::result;
  std::uint64_t cell = 0;
  std::uint64_t size = 0;
};

/// What every worker of a sweep shares. Everything outlives the workers.
struct WorkerContext {
  const Sweep& sweep;
  const std::vector<Cell>& cells;
  const Catalogue& catalogue;
  const DataRoot& root;
};

/// Reads jobs from `socket` and answers there until it is closed. `pinned`: the core to stay on,
/// or -1. Never throws; ends early when it cannot answer.
void serve(const WorkerContext& context, int socket, Board& board, int pinned);

/// Steady clock [ns], the same in every process.
std::int64_t steady_nanoseconds();

}  // namespace loopbench
