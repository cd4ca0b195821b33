/// A metric that means nothing here.
#pragma once

#include <stdexcept>

namespace loopbench {

/// What a metric throws when the sequence, not the method, leaves it without meaning: no closures,
/// no curve, a reference that stands still. A row `declined` with this reason, not a failure.
class Undefined final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace loopbench
