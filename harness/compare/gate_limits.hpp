/// The limits of a gate.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/compare/baseline.hpp"

namespace loopbench::harness {

/// A function that returns the first of the limits whose `where` selects a score, or null. It keeps
/// references to `limits`.
std::function<const Tolerance*(const Record&)> limit_of(const std::vector<Tolerance>& limits);

/// Throws InputError if the baseline has no limits, or a limit that selects none of its scores:
/// such a limit is misspelt and would let every change pass. A baseline without any score is only
/// about statuses.
void require_used_limits(const Baseline& baseline);

/// A line for every limit that is not the default, because a wide limit lets changes pass.
std::vector<std::string> notes_on_limits(const std::vector<Tolerance>& limits);

}  // namespace loopbench::harness
