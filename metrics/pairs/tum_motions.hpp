/// The pairs of TUM's evaluate_rpe.py: with --fixed_delta, and random ones.
#pragma once

#include "metrics/pairs/stretch.hpp"

namespace loopbench {

/// poses.estimate is the whole estimate, moved by the alignment; poses.reference[i] the reference
/// pose nearest in time to estimate pose i, however far.
struct TumMotions {
  Paired poses;
  std::vector<FromTo> pairs;
};

/// Every estimate pose i with the j whose measure is nearest to i's plus delta by the tool's own
/// bisection, unless j is the last pose or either gap to the reference exceeds twice the median
/// reference interval. Measures: stamps, frames, path, turning (trace formula), of the estimate.
/// j = i happens, as there, when the steps are longer than 2 delta. All pairs are taken, as with
/// its
/// --max_pairs 0; from 10001 pairs on its default draws 10000 of them. m, rad and deg follow its
/// text; under Python 3 they crash there. Stands in evo's test/tum_benchmark_tools (26d0953). O(n
/// log m).
TumMotions tum_motions(const Paired& whole,
                       double offset,
                       const Alignment& alignment,
                       const Stretch& stretch);

/// The tool's mode without --fixed_delta: 10000 pairs (i, j) drawn from all poses of the estimate
/// as Python 3 draws them from seed 0, i = j and either order allowed, or all n^2 pairs of fewer
/// than 100 poses; those at a gap of the reference are left out as above. O(n log m).
TumMotions tum_random_motions(const Paired& whole, double offset, const Alignment& alignment);

/// find_closest_index of the tool: a bisection with a running best. On a tie the one probed first
/// wins, which need not be the earlier one. `sorted` is not empty.
std::size_t tum_closest_index(const std::vector<double>& sorted, double wanted);

}  // namespace loopbench
