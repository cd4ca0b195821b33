/// Which reference pose and which estimate pose belong together in time.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench {

struct IndexPair {
  std::size_t reference = 0;
  std::size_t estimate = 0;
  friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

/// evo (core/sync.py, commit 26d0953): for each stamp of the shorter list (the estimate when both
/// are equally long) the nearest of the longer, the first of two equally near, kept when the
/// difference is <= max_diff. One stamp of the longer list may serve twice. Rounding as there: the
/// offset is added to the estimate when that is longer, else taken off the reference.
/// In the order of the shorter list. Strictly increasing stamps. O(n + m).
std::vector<IndexPair> match_evo(std::vector<double> reference,
                                 std::vector<double> estimate,
                                 double max_diff,
                                 double offset);

/// Is a difference of exactly max_diff still a pair?
enum class Limit { strict, inclusive };

/// May an earlier reference pose go with a later estimate pose than the next one does?
enum class Crossing { allowed, refused };

/// TUM's associate.py (strict, crossing allowed), and `nearest` (inclusive, crossing refused):
/// one-to-one; of all pairs within max_diff the one first by (difference, reference, estimate) is
/// taken, both poses leave, and so on, passing over pairs that cross a taken one when those are
/// refused. Around a burst associate.py pairs what a taken pair left over across it, and the
/// estimate runs backwards there. In the order of the reference. Strictly increasing stamps, also
/// after the offset was added to the estimate. O((n + m) log(n + m)) whatever max_diff is, in
/// practice near O(n + m).
std::vector<IndexPair> match_one_to_one(const std::vector<double>& reference,
                                        std::vector<double> estimate,
                                        double max_diff,
                                        Limit limit,
                                        Crossing crossing,
                                        double offset);

/// ov_eval (AlignUtils.cpp, commit 6948812): estimate poses in order, a pointer into the reference
/// that only moves on, so each reference pose serves once; strict |dt| < max_diff. Not always the
/// nearest pairs: an early estimate pose may take what a later one is nearer to. O(n + m).
std::vector<IndexPair> match_ov_eval(const std::vector<double>& reference,
                                     const std::vector<double>& estimate,
                                     double max_diff,
                                     double offset);

/// Equally long; element i of one belongs to element i of the other. The estimate keeps its stamps.
struct Paired {
  Trajectory reference;
  Trajectory estimate;
};

/// `interpolate`: the reference on its straight lines and great arcs at estimate stamp + offset,
/// unless that lies outside the reference or between two poses more than max_gap (and a microsecond
/// for the rounding of stamps) apart; a stamp
/// the reference holds needs no neighbour. O(n + m).
Paired interpolate_reference(const Trajectory& reference,
                             const Trajectory& estimate,
                             double max_gap,
                             double offset);

/// Pairs by the protocol's rule; empty when nothing matches. Throws std::runtime_error when
/// association `index` meets lists of different size.
Paired associate(const Trajectory& reference, const Trajectory& estimate, const Protocol& protocol);

}  // namespace loopbench
