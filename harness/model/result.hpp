/// What one cell leaves behind.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/model/cells.hpp"
#include "harness/model/sequence_facts.hpp"
#include "methods/report.hpp"
#include "metrics/metric.hpp"

namespace loopbench {

enum class Status {
  ok,
  declined,       ///< not for this method, or a number that means nothing here: not an error
  failed,         ///< threw anything but Undefined, or gave what is not finite
  incomplete,     ///< judged below the sweep's min_coverage: kept, but not averaged or ranked
  crashed,        ///< its worker process died of a signal
  timeout,        ///< it ran longer than the sweep's limit
  out_of_memory,  ///< it grew above the sweep's limit, or could not get what it asked for
};
inline auto choices(Status) {
  return std::array{std::pair{"ok", Status::ok},
                    std::pair{"declined", Status::declined},
                    std::pair{"failed", Status::failed},
                    std::pair{"incomplete", Status::incomplete},
                    std::pair{"crashed", Status::crashed},
                    std::pair{"timeout", Status::timeout},
                    std::pair{"out_of_memory", Status::out_of_memory}};
}

/// Something went wrong: not merely declined or incomplete.
inline bool is_failure(Status status) {
  return status == Status::failed || status == Status::crashed || status == Status::timeout ||
         status == Status::out_of_memory;
}

/// One metric under one protocol at one choice of times; when it is undefined there, only status
/// and why are filled.
struct ScoreResult {
  std::size_t protocol = 0;  ///< into Sweep::protocols
  Times times = Times::keyframes;
  std::string metric;  ///< catalogue name
  std::string label;   ///< in the config
  Score score;
  Coverage coverage;
  Status status = Status::ok;
  std::string why;
};

/// How the cell was run.
struct Worker {
  bool isolated = false;  ///< in a worker process of its own kind: its end is not the sweep's
  bool serial = false;    ///< nothing else of the sweep ran meanwhile
  bool pinned = false;    ///< held on one core
};

struct CellResult {
  Cell cell;
  Status status = Status::ok;
  std::string why;
  std::string signal;  ///< "SIGSEGV"; empty unless a signal ended it
  Worker worker;
  std::vector<double> seconds;              ///< wall time of the method's verb, one per timed run
  std::vector<double> cpu_seconds;          ///< CPU time of the process meanwhile; empty: not known
  std::optional<std::int64_t> peak_memory;  ///< largest resident size of the process [bytes]
  std::optional<std::int64_t> added_memory;  ///< of it, beyond what it had before [bytes]
  std::optional<std::int64_t> allocations;   ///< calls for memory in one run of the verb
  Report report;                             ///< of the last timed run
  std::vector<ScoreResult> scores;
  bool oracle_method = false;  ///< it was shown the reference, or was trained on it
  CellTrace trace;             ///< under the first protocol, dense if the sweep judges densely
  std::shared_ptr<const SequenceFacts> facts;  ///< null when its sequence never finished loading
};

}  // namespace loopbench
