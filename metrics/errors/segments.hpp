/// Errors of sub-trajectories of given lengths: KITTI's drift, rpg's and ov_eval's relative errors.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench {

struct SegmentsOptions {
  std::string lengths;
  bool each = true;
};

template <class Visit>
void fields(SegmentsOptions& o, Visit visit) {
  visit("lengths", o.lengths, "metres or % of the reference's path; empty: the protocol's");
  visit("each", o.each, "also one set of scores for each length");
}

/// Throws OptionError for lengths that are no positive numbers.
void check_combination(const SegmentsOptions& options);

/// By the protocol's segments, form and angle. Axis `all`: translation [%] and rotation [deg/m] of
/// all sub-trajectories of all lengths. Axis `8 m` or `10%` for each length: these two and
/// translation [m], rotation [deg], and of E turned into the world yaw [deg] and gravity [deg], the
/// root of squared roll and pitch. Shares of the path are cut to whole centimetres as rpg does.
/// Errors per metre divide by the length asked for; with end eth3d by the metres gone. Lengths with
/// fewer than segments.fewest sub-trajectories are left out. precision float32: the devkit's float
/// arithmetic and float sums (`mean`), only % and deg/m. Throws Undefined when nothing is left, and
/// for positions without attitude, which turns every motion into its body (position_only.hpp).
/// O(lengths * n log n).
std::vector<Score> segments(const Evaluation& evaluation, const SegmentsOptions& options);

}  // namespace loopbench
