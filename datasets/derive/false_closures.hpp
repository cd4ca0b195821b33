/// Closures that are not: places taken for one another, added on purpose.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"

namespace loopbench {

struct FalseClosures {
  double share = 0.0;  ///< of all closures afterwards [-]
  std::int64_t seed = 1;
};

template <class Visit>
void false_closure_fields(FalseClosures& o, Visit visit) {
  visit("false_closures.share",
        o.share,
        "false ones among all, added to those of the data [-]",
        Between{0.0, 0.95});
  visit("false_closures.seed", o.seed, "which places are confused", Between{0});
}

/// Adds false closures until they are `share` of all: two keyframes drawn at random, at least a
/// twentieth of the chain apart, with what a closure of the problem measured and how sure it was,
/// also drawn. Whether they happen to lie near each other is not asked: the truth is not looked at.
/// Returns how many. Keeps closures sorted; the same seed gives the same ones, whatever the
/// standard library. Nothing is added where there are no closures or fewer than 40 keyframes.
/// O(closures log closures).
std::size_t add_false_closures(Problem& problem, const FalseClosures& options);

}  // namespace loopbench
