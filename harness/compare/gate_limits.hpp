/// The limit that applies to a score.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

class LimitOfScore {
 public:
  explicit LimitOfScore(const std::vector<Tolerance>& limits);

  /// The first limit whose `where` selects the score; null if none does.
  const Tolerance* operator()(const GateCell& cell, const GateScore& score) const;

 private:
  struct Filter {
    std::function<bool(const Record&)> keeps;
    const Tolerance* limit = nullptr;
  };
  std::vector<Filter> filters_;
};

/// Throws InputError if the baseline has no limits, or a limit that selects none of its scores:
/// such a limit is misspelt and would let every change pass. A baseline without any score is only
/// about statuses.
void require_used_limits(const Baseline& baseline);

/// A line for every limit that is not the default, because a wide limit lets changes pass.
std::vector<std::string> notes_on_limits(const std::vector<Tolerance>& limits);

}  // namespace loopbench::harness
