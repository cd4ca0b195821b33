/// Pairs of relative motions as the scripts of TUM choose them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "metrics/alignment/alignment.hpp"
#include "metrics/pairing/association.hpp"
#include "metrics/pairing/select_pairs.hpp"

namespace loopbench::metrics {

/// random.seed(0), then random.randint or random.sample: MT19937 seeded by the array {0}
/// (Matsumoto and Nishimura's init_by_array), integers by rejection sampling (random.py,
/// _randbelow_with_getrandbits). Identical in every Python from 3.2 on; Python 2 differs.
class PythonRandom {
 public:
  PythonRandom();

  /// Uniform integer in 0 .. size - 1, as randint(0, size - 1). 0 < size < 2^32.
  std::size_t below(std::size_t size);

  /// `count` distinct integers of 0 .. size - 1, as sample(range(size), count). count <= size <
  /// 2^32. O(size) where Python copies the population, otherwise O(count).
  std::vector<std::size_t> sample(std::size_t size, std::size_t count);

 private:
  std::mt19937 bits_;
};

/// Aligned estimate poses that some pair uses, each with the reference pose nearest in time; pairs
/// of indices into them.
struct TumMotions {
  Paired poses;
  std::vector<FromTo> pairs;
};

/// Every estimate pose i with the j whose measure is nearest to i's plus delta by the tool's own
/// bisection, unless j is the last pose. If there are more than `max_pairs` (0: no limit), a
/// subset as drawn by the tool's random.sample in Python 3 from seed 0, in drawing order. Then
/// pairs are removed if either time difference to the reference exceeds twice the median reference
/// interval. Measures: stamps, frames, path length, rotation angle (trace formula), of the
/// estimate. j = i occurs, as in the tool, if the steps are longer than 2 delta. m, rad and deg
/// follow its source, which crashes there under Python 3. Source: evo's test/tum_benchmark_tools
/// (26d0953). O(n log n), and O(log m) for each pose of a pair.
TumMotions tum_motions(const Paired& complete,
                       double offset,
                       const Alignment& alignment,
                       const PairDelta& pair_delta,
                       std::size_t max_pairs);

/// The tool's mode without --fixed_delta: `max_pairs` pairs (i, j) drawn from all poses of the
/// estimate as Python 3 draws them from seed 0, where i = j and either order can occur, or all n^2
/// pairs if there are fewer. Pairs at a reference gap are removed as above. O(max_pairs log m).
TumMotions tum_random_motions(const Paired& complete,
                              double offset,
                              const Alignment& alignment,
                              std::size_t max_pairs);

/// find_closest_index of the tool: a bisection that keeps the best index. On a tie, the index
/// probed first wins, which is not always the earlier one. `sorted` is not empty.
std::size_t tum_closest_index(const std::vector<double>& sorted, double wanted);

}  // namespace loopbench::metrics
