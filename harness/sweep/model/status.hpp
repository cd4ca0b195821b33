/// Outcome of a cell or of one of its scores.
#pragma once

#include <array>
#include <utility>

#include "datasets/core/fields.hpp"

namespace loopbench::harness {

enum class Status {
  ok,
  declined,       ///< the method is not applicable, or a metric is undefined: not an error
  failed,         ///< threw an exception other than Undefined, or returned non-finite values
  incomplete,     ///< coverage below the sweep's min_coverage: stored, but not averaged or ranked
  crashed,        ///< its worker process was ended by a signal
  timeout,        ///< it exceeded the sweep's time limit
  out_of_memory,  ///< it exceeded the sweep's memory limit, or an allocation failed
  interrupted,    ///< the user abandoned it: not an error, not stored, and so run again
};
inline auto choices(Status) {
  return std::array{std::pair{"ok", Status::ok},
                    std::pair{"declined", Status::declined},
                    std::pair{"failed", Status::failed},
                    std::pair{"incomplete", Status::incomplete},
                    std::pair{"crashed", Status::crashed},
                    std::pair{"timeout", Status::timeout},
                    std::pair{"out_of_memory", Status::out_of_memory},
                    std::pair{"interrupted", Status::interrupted}};
}

/// Whether the status is an error, that is, not merely declined, incomplete or interrupted.
inline bool is_failure(Status status) {
  return status == Status::failed || status == Status::crashed || status == Status::timeout ||
         status == Status::out_of_memory;
}

/// Whether scores with the status have numbers, which are averaged and ranked only if it is ok.
inline bool has_numbers(Status status) {
  return status == Status::ok || status == Status::incomplete;
}

}  // namespace loopbench::harness
