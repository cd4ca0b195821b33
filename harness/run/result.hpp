/// What one cell leaves behind.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "harness/run/cells.hpp"
#include "methods/report.hpp"
#include "metrics/metric.hpp"

namespace loopbench {

enum class Status {
  ok,
  declined,    ///< not for this method, or a number that means nothing here: not an error
  failed,      ///< the method or a metric threw
  incomplete,  ///< judged below the sweep's min_coverage: kept, but not averaged or ranked
};
inline auto choices(Status) {
  return std::array{std::pair{"ok", Status::ok},
                    std::pair{"declined", Status::declined},
                    std::pair{"failed", Status::failed},
                    std::pair{"incomplete", Status::incomplete}};
}

/// One metric under one protocol at one choice of times; when it is undefined there, only status
/// and why are filled.
struct ScoreResult {
  std::size_t protocol = 0;  ///< into Sweep::protocols
  Times times = Times::keyframes;
  std::string metric;  ///< label
  Score score;
  Coverage coverage;
  Status status = Status::ok;
  std::string why;
};

struct CellResult {
  Cell cell;
  Status status = Status::ok;
  std::string why;
  std::vector<double> seconds;  ///< wall time of the method's verb, one per timed run
  Report report;                ///< of the last timed run
  std::vector<ScoreResult> scores;
  std::string closures;          ///< where the loop closures came from
  bool oracle_closures = false;  ///< they were measured in the reference
  bool oracle_method = false;    ///< the method was shown the reference
};

}  // namespace loopbench
