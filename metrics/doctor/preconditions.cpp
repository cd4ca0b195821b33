#include "metrics/doctor/preconditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/doctor/common_motion.hpp"
#include "metrics/doctor/frame_checks.hpp"
#include "metrics/doctor/unit_checks.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {
namespace {

struct TimeRange {
  double begin = 0.0;
  double end = 0.0;

  double length() const { return end - begin; }
};

TimeRange range_of(const Trajectory& poses, double factor = 1.0) {
  return {factor * poses.front().stamp, factor * poses.back().stamp};
}

/// Length of the common range; negative: the distance between the ranges.
double overlap(const TimeRange& a, const TimeRange& b) {
  return std::min(a.end, b.end) - std::max(a.begin, b.begin);
}

const char* fraction_name(double factor) {
  if (factor == 1e3) return "milliseconds";
  return factor == 1e6 ? "microseconds" : "nanoseconds";
}

/// Largest angle to the first rotation [rad].
double largest_rotation(const Trajectory& poses) {
  double out = 0.0;
  for (const StampedPose& pose : poses) {
    out = std::max(
        out, angle_between(poses.front().world_from_body.rotation, pose.world_from_body.rotation));
  }
  return out;
}

/// Largest distance to the first position [m].
double largest_distance(const Trajectory& poses) {
  double out = 0.0;
  for (const StampedPose& pose : poses) {
    out = std::max(
        out, (pose.world_from_body.translation - poses.front().world_from_body.translation).norm());
  }
  return out;
}

constexpr double kConstant = 1e-6;  // [rad]

}  // namespace

std::optional<InputFinding> check_stamp_unit(const Trajectory& reference,
                                             const Trajectory& estimate) {
  constexpr double kHardly = 0.01, kMostly = 0.5, kLeastPart = 0.05;
  if (reference.size() < 2 || estimate.size() < 2) return std::nullopt;
  const TimeRange of_reference = range_of(reference), of_estimate = range_of(estimate);
  const double longer = std::max(of_reference.length(), of_estimate.length());
  if (overlap(of_reference, of_estimate) > kHardly * longer) return std::nullopt;
  for (const double factor : {1e3, 1e6, 1e9}) {
    for (const bool is_reference : {false, true}) {
      const TimeRange a = range_of(reference, is_reference ? 1.0 / factor : 1.0);
      const TimeRange b = range_of(estimate, is_reference ? 1.0 : 1.0 / factor);
      const double shorter = std::min(a.length(), b.length());
      const bool is_alike = shorter > kLeastPart * std::max(a.length(), b.length());
      if (!is_alike || overlap(a, b) < kMostly * shorter) continue;
      return InputFinding{
          Fault::stamp_unit,
          fmt::format("the stamps of the {} are {:g} times too large: {:.3f} to {:.3f}, those of "
                      "the {} {:.3f} to {:.3f}",
                      is_reference ? "reference" : "estimate",
                      factor,
                      (is_reference ? of_reference : of_estimate).begin,
                      (is_reference ? of_reference : of_estimate).end,
                      is_reference ? "estimate" : "reference",
                      (is_reference ? of_estimate : of_reference).begin,
                      (is_reference ? of_estimate : of_reference).end),
          fmt::format("traj transform {} --stamp-scale {:g} ({})",
                      is_reference ? "REF" : "EST",
                      1.0 / factor,
                      fraction_name(factor)),
          1.0,
          is_reference ? 1.0 / factor : factor};
    }
  }
  return std::nullopt;
}

std::optional<InputFinding> check_overlap(const Trajectory& reference, const Trajectory& estimate) {
  if (reference.empty() || estimate.empty()) return std::nullopt;
  const TimeRange a = range_of(reference), b = range_of(estimate);
  const double distance = -overlap(a, b);
  if (!(distance > 0.0)) return std::nullopt;
  return InputFinding{Fault::no_overlap,
                      fmt::format("the estimate's stamps ({:.3f} to {:.3f} s) and the reference's "
                                  "({:.3f} to {:.3f} s) have no common time",
                                  b.begin,
                                  b.end,
                                  a.begin,
                                  a.end),
                      "give files of the same recording, or the offset of their clocks (--offset)",
                      1.0,
                      distance};
}

std::optional<InputFinding> check_constant_rotation(const Trajectory& reference,
                                                    const Trajectory& estimate) {
  constexpr double kMoves = 0.5;         // [m]
  constexpr double kOtherRotates = 0.3;  // [rad]
  constexpr std::size_t kFewestPoses = 10;
  if (reference.size() < kFewestPoses || estimate.size() < kFewestPoses) return std::nullopt;
  if (lacks_rotations(reference) || lacks_rotations(estimate)) return std::nullopt;
  const double of_reference = largest_rotation(reference);
  const double of_estimate = largest_rotation(estimate);
  if (std::min(of_reference, of_estimate) > kConstant) return std::nullopt;
  const bool is_reference = of_reference < of_estimate;
  const double distance = largest_distance(is_reference ? reference : estimate);
  const double rotation = std::max(of_reference, of_estimate);
  if (distance < kMoves || rotation < kOtherRotates) return std::nullopt;
  return InputFinding{
      Fault::constant_rotation,
      fmt::format("the {}'s rotation is constant while it moves by {:.3g} m and the {} rotates by "
                  "{:.0f} deg",
                  is_reference ? "reference" : "estimate",
                  distance,
                  is_reference ? "estimate" : "reference",
                  kDegrees * rotation),
      "write the file with rotations, or use position errors only (eval -r trans_part)",
      1.0,
      rotation};
}

Unchecked unchecked_parts(const Trajectory& reference, const Trajectory& estimate) {
  Unchecked out;
  const CommonPoses common = common_poses(reference, estimate, 0.0, kMostFramePoses);
  const std::size_t poses = common.stamps.size();
  const auto too_few = [&](const char* checks, std::size_t fewest) {
    if (poses >= fewest) return false;
    out.reasons.push_back(
        fmt::format("{}: {} poses of the estimate are in the reference's time, expected "
                    "at least {}",
                    checks,
                    poses,
                    fewest));
    return true;
  };
  out.checks_units = !too_few("units, scale", kFewestUnitPoses);
  if (too_few("quaternion order, inverted poses, axes", kFewestFramePoses)) return out;
  for (const bool is_reference : {true, false}) {
    if (has_rotations(is_reference ? common.reference : common.estimate)) continue;
    const bool lacks = lacks_rotations(is_reference ? reference : estimate);
    out.reasons.push_back(
        fmt::format("quaternion order, inverted poses, axes, unit of angles: the {} {}",
                    is_reference ? "reference" : "estimate",
                    lacks ? "has positions without rotation"
                          : fmt::format("does not rotate by {:g} rad", kLeastRotation)));
    break;
  }
  return out;
}

}  // namespace loopbench::metrics
