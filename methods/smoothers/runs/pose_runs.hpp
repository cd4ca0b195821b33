/// Parts of trajectories: positions, rotations, and runs between intervals that no smooth curve
/// should bridge, joined by chords.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "datasets/core/curve.hpp"
#include "datasets/core/trajectory.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

inline std::vector<Vector3> positions_of(const Trajectory& poses) {
  std::vector<Vector3> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.translation);
  return out;
}

inline std::vector<Rotation> rotations_of(const Trajectory& poses) {
  std::vector<Rotation> out;
  out.reserve(poses.size());
  for (const StampedPose& pose : poses) out.push_back(pose.world_from_body.rotation);
  return out;
}

/// Returns why a method that requires `least` keyframes declines, or an empty text.
inline std::string too_few_keyframes(const Trajectory& keyframes, std::size_t least) {
  if (keyframes.size() >= least) return "";
  return std::to_string(keyframes.size()) + " keyframes, fewer than " + std::to_string(least);
}

/// Segment of consecutive poses first .. last, both included.
struct PoseRun {
  std::size_t first, last;

  bool operator==(const PoseRun&) const = default;
};

/// Splits at least one pose into segments at the intervals (i, i + 1) for which `cut(i)` holds.
/// O(n).
std::vector<PoseRun> runs_without_breaks(std::size_t poses,
                                         const std::function<bool(std::size_t)>& cut);

/// Intervals below this times the median are bridged by chords: a spline through both poses takes
/// the difference of their errors for a velocity, and overshoots by many times that difference.
inline constexpr double kShortestInterval = 0.01;

/// Joins the parts by chords: straight lines and great arcs from the end of each part to the start
/// of the next. The parts must be in order of time, must not overlap, and must contain at least two
/// different times.
std::unique_ptr<const Curve> joined(std::vector<std::unique_ptr<const Curve>> parts);

/// Smooths each segment separately and joins the results. `report` gets the counts of the longest
/// segment, the count `chords`, the phases, sections and notes of all segments, and a note with
/// `reason` and the location of the first chord. With one segment the result is exactly that of
/// `smooth`.
std::unique_ptr<const Curve> smooth_segments(
    const Trajectory& poses,
    const std::vector<PoseRun>& runs,
    const std::string& reason,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(Trajectory, Report&)>& smooth);

/// smooth_segments() with the segments between short intervals. O(n) besides `smooth`.
std::unique_ptr<const Curve> smooth_between_short_intervals(
    const Trajectory& poses,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(Trajectory, Report&)>& smooth);

/// Interpolates rotations that a single curve cannot follow. Splits the trajectory at every step
/// above 2 rad, and where `solve` still fails at the largest step. `solve` returns a curve through
/// the poses, or null. Great arcs join the parts, with a note. Positions are ignored. O(n) calls of
/// `solve` in the worst case.
std::unique_ptr<const Curve> interpolate_rotations_in_parts(
    const Trajectory& poses,
    Report& report,
    const std::function<std::unique_ptr<const Curve>(const Trajectory&)>& solve);

}  // namespace loopbench::methods
