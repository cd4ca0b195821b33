/// Closures that are not: places taken for one another, added on purpose.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/core/fields.hpp"
#include "datasets/core/problem.hpp"
#include "datasets/noise_stream.hpp"

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

/// Adds false closures until they are `share` of all, rounded to a whole number: two random
/// keyframes, at least two and at least a twentieth of the chain apart, with measurement and
/// information of a random closure of the problem. The truth is not used, so a false closure may
/// join keyframes that are close to each other. Keeps closures sorted; the same stream gives the
/// same closures with every standard library. Returns their number: 0 where the problem has no
/// closures. Throws InputError for a chain of fewer than 3 keyframes. O(closures log closures).
std::size_t add_false_closures(Problem& problem,
                               const FalseClosures& options,
                               std::uint64_t noise_identity);

/// For provenance: ", 5 of 10 false and added"; empty when none were asked for.
std::string false_closures_text(const FalseClosures& options, std::size_t added, std::size_t all);

}  // namespace loopbench
