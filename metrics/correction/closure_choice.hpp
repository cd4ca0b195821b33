/// Mistakes of a method that chooses among loop closures, where the false ones are known.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// Closures of a problem by what they are and by what the method did.
struct ClosureChoice {
  std::size_t false_ones = 0;
  std::size_t kept_false = 0;
  std::size_t true_ones = 0;
  std::size_t dropped_true = 0;
};

/// Throws Undefined if it is not known which closures are false, or if the method does not state
/// which ones it rejected. O(closures).
inline ClosureChoice closure_choice(const Evaluation& evaluation) {
  const Context& context = evaluation.context;
  const Problem& problem = needed(context.problem, "loop closures");
  if (context.false_closures == nullptr) {
    throw Undefined(
        "which closures are false is not known; simulated closures, those measured in the "
        "reference, and false_closures.share have labels");
  }
  if (context.rejected_closures == nullptr) {
    throw Undefined("the method does not state which closures it rejects");
  }
  ClosureChoice out;
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const bool is_false = std::ranges::binary_search(*context.false_closures, k);
    const bool is_rejected = std::ranges::binary_search(*context.rejected_closures, k);
    out.false_ones += is_false ? 1 : 0;
    out.true_ones += is_false ? 0 : 1;
    out.kept_false += is_false && !is_rejected ? 1 : 0;
    out.dropped_true += !is_false && is_rejected ? 1 : 0;
  }
  return out;
}

inline Score share_of(std::size_t part, std::size_t all) {
  return single("share", "", "%", 100.0 * static_cast<double>(part) / static_cast<double>(all));
}

/// `share` [%]: false closures that the method kept, of all false ones. Throws Undefined if none is
/// false, and what closure_choice() throws. Needs no reference. O(closures).
inline std::vector<Score> closures_kept_false(const Evaluation& evaluation, const NoOptions&) {
  const ClosureChoice found = closure_choice(evaluation);
  if (found.false_ones == 0) throw Undefined("no closure is false");
  return {share_of(found.kept_false, found.false_ones)};
}

/// `share` [%]: true closures that the method rejected, of all true ones. A method that returns the
/// keyframes unchanged because it cannot decide rejects all. Throws Undefined if none is true, and
/// what closure_choice() throws. Needs no reference. O(closures).
inline std::vector<Score> closures_dropped_true(const Evaluation& evaluation, const NoOptions&) {
  const ClosureChoice found = closure_choice(evaluation);
  if (found.true_ones == 0) throw Undefined("no closure is true");
  return {share_of(found.dropped_true, found.true_ones)};
}

}  // namespace loopbench::metrics
