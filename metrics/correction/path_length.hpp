/// Is the way as long as the reference's?
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct PathLengthOptions {};

template <class Visit>
void fields(PathLengthOptions&, Visit) {}

/// Sum of the straight steps between judged poses, after alignment: estimate [m], reference
/// [m], ratio [1] = estimate over reference. Both are sampled at the same pairs,
/// so neither gains by being denser; jitter still lengthens.
/// sim3 alignment takes most of the ratio away. Throws Undefined when the reference
/// stands still. O(n).
std::vector<Score> path_length_ratio(const Evaluation& evaluation,
                                     const PathLengthOptions& options);

}  // namespace loopbench
