/// The pairs of TUM's evaluate_rpe.py: with --fixed_delta, and random ones.
#pragma once

#include "metrics/alignment/alignment.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/pairing/pairs/stretch.hpp"

namespace loopbench {

/// Poses of the estimate that some pair uses, moved by the alignment, and beside each the reference
/// pose nearest in time; pairs of indices into them.
struct TumMotions {
  Paired poses;
  std::vector<FromTo> pairs;
};

/// Every estimate pose i with the j whose measure is nearest to i's plus delta by the tool's own
/// bisection, unless j is the last pose. Of more than `max_pairs` (0: any number) the tool's
/// random.sample: as Python 3 draws from seed 0, in the order drawn. Then left out: pairs of which
/// either gap to the reference exceeds twice the median reference interval. Measures: stamps,
/// frames, path, turning (trace formula), of the estimate. j = i happens, as there, when the steps
/// are longer than 2 delta. m, rad and deg follow its text; under Python 3 they crash there. Stands
/// in evo's test/tum_benchmark_tools (26d0953). O(n log n), and O(log m) for each pose of a pair.
TumMotions tum_motions(const Paired& whole,
                       double offset,
                       const Alignment& alignment,
                       const Stretch& stretch,
                       std::size_t max_pairs);

/// The tool's mode without --fixed_delta: `max_pairs` pairs (i, j) drawn from all poses of the
/// estimate as Python 3 draws them from seed 0, i = j and either order allowed, or all n^2 pairs
/// when there are fewer; those at a gap of the reference are left out as above. O(max_pairs log m).
TumMotions tum_random_motions(const Paired& whole,
                              double offset,
                              const Alignment& alignment,
                              std::size_t max_pairs);

/// find_closest_index of the tool: a bisection with a running best. On a tie the one probed first
/// wins, which need not be the earlier one. `sorted` is not empty.
std::size_t tum_closest_index(const std::vector<double>& sorted, double wanted);

}  // namespace loopbench
