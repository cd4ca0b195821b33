/// Exception for metrics that are undefined for a sequence.
#pragma once

#include <stdexcept>

namespace loopbench::metrics {

/// Thrown by a metric if the sequence, not the method, makes it undefined: no closures, no curve, a
/// reference that does not move. Recorded as a `declined` row with this reason, not as a failure.
class Undefined final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace loopbench::metrics
