/// Association of reference poses and estimate poses in time.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/protocols/protocol.hpp"

namespace loopbench::metrics {

/// What a gap between stamps may exceed its limit by: printed stamps are rounded to microseconds,
/// and differences of large ones to 2e-7 s [s].
constexpr double kStampRounding = 1e-6;

struct IndexPair {
  std::size_t reference = 0;
  std::size_t estimate = 0;
  friend bool operator==(const IndexPair&, const IndexPair&) = default;
};

/// evo (core/sync.py, commit 26d0953): for each stamp of the shorter list (the estimate if both
/// are equally long) the nearest stamp of the longer list, the first of two equally near ones, kept
/// if the difference is <= max_diff. A stamp of the longer list can be paired twice. Rounding as in
/// evo: the offset is added to the estimate if that list is longer, otherwise subtracted from the
/// reference. Result in the order of the shorter list. Stamps must not decrease: both poses of a
/// repeated stamp of the shorter list are paired, of the longer list the first. O(n + m).
std::vector<IndexPair> match_evo(std::vector<double> reference,
                                 std::vector<double> estimate,
                                 double max_diff,
                                 double offset);

/// Whether a difference of exactly max_diff is accepted.
enum class Limit { strict, inclusive };

/// Whether pairs may cross: an earlier reference pose paired with a later estimate pose.
enum class Crossing { allowed, refused };

/// TUM's associate.py (strict, crossing allowed) and `nearest` (inclusive, crossing rejected).
/// One-to-one and greedy: repeatedly takes the pair that is first by (difference, reference,
/// estimate) among all pairs within max_diff, and removes both poses. If crossing is rejected,
/// pairs that cross a taken pair are skipped. Around a burst of stamps, associate.py pairs the
/// remaining poses across a taken pair, so the estimate's stamps decrease there. Result in the
/// order of the reference. Stamps must strictly increase, also after the offset is added to the
/// estimate. O((n + m) log(n + m)) for any max_diff, in practice near O(n + m).
std::vector<IndexPair> match_one_to_one(const std::vector<double>& reference,
                                        std::vector<double> estimate,
                                        double max_diff,
                                        Limit limit,
                                        Crossing crossing,
                                        double offset);

/// Paired trajectories of equal length: element i of one is paired with element i of the other. The
/// estimate keeps its own stamps.
struct Paired {
  Trajectory reference;
  Trajectory estimate;
};

/// Association `interpolate`: interpolates the reference (linear and slerp) at estimate stamp +
/// offset. Skips stamps outside the reference, and stamps between two reference poses more than
/// max_gap + kStampRounding apart, unless a reference pose has exactly that stamp. O(n + m).
Paired interpolate_reference(const Trajectory& reference,
                             const Trajectory& estimate,
                             double max_gap,
                             double offset);

/// Association `interpolate_estimate`: the same with exchanged roles. The estimate is interpolated
/// at reference stamp - offset, in gaps of at most max_gap. O(n + m).
Paired interpolate_estimate(const Trajectory& reference,
                            const Trajectory& estimate,
                            double max_gap,
                            double offset);

/// Pairs by the protocol's association; empty if nothing matches. Throws std::runtime_error if
/// association `index` is used with lists of different size.
Paired associate(const Trajectory& reference, const Trajectory& estimate, const Protocol& protocol);

}  // namespace loopbench::metrics
