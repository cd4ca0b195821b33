/// Errors of sub-trajectories of given lengths: KITTI's drift and rpg's relative errors.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct SegmentsOptions {
  std::string lengths;
  bool each = true;
};

template <class Visit>
void fields(SegmentsOptions& o, Visit visit) {
  visit("lengths",
        o.lengths,
        "lengths in metres or % of the reference's path length; empty: the protocol's");
  visit("each", o.each, "also report scores for each length");
}

/// Throws OptionError for lengths that are not positive numbers.
void check_combination(const SegmentsOptions& options);

/// Errors by the protocol's segments, form and angle. Axis `all`: translation [%] and rotation
/// [deg/m] of all sub-trajectories of all lengths. Axis `8 m` or `10%` for each length: these two
/// and translation [m], rotation [deg], and of E rotated into the world yaw [deg] and gravity
/// [deg], the root of squared roll and pitch. Relative lengths are truncated to centimetres as in
/// rpg. Errors per metre divide by the nominal length.
/// Lengths with fewer than segments.fewest sub-trajectories are skipped. precision float32: the
/// devkit's float arithmetic and float sums (`mean`), only % and deg/m. Throws Undefined if nothing
/// remains, and for trajectories that hold only positions, because every relative motion needs an
/// orientation (position_only.hpp). O(lengths * n log n).
std::vector<Score> segments(const Evaluation& evaluation, const SegmentsOptions& options);

}  // namespace loopbench::metrics
