/// A likely mistake in the input of an evaluation.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

namespace loopbench::metrics {

enum class Fault {
  time_offset,
  stamp_unit,         ///< milliseconds, microseconds or nanoseconds for seconds
  repeated_stamps,    ///< poses with the stamp of the one before
  frame_indices,      ///< frame numbers instead of seconds
  clock_drift,        ///< clocks of different rates
  no_overlap,         ///< no common time
  missing_poses,      ///< large gaps in the estimate
  wrong_recording,    ///< files of different recordings
  jumps,              ///< positions jump
  constant_rotation,  ///< one file has no rotations
  quaternion_order,
  conjugated,              ///< rotations are inverted, positions are not
  inverted_poses,          ///< world and body are exchanged
  axes,                    ///< mirrored or permuted axes
  angle_unit,              ///< degrees for radians, or radians for degrees
  length_unit,             ///< millimetres or centimetres for metres
  scale,                   ///< an estimate without metric scale, aligned without scale
  swapped,                 ///< reference and estimate are exchanged
  closure_direction,       ///< closures from `to` to `from`
  odometry_direction,      ///< odometry from `to` to `from`
  closure_rotation,        ///< quaternion order or unit of angles of closures
  closure_unit,            ///< length units of closures and odometry differ
  closure_frame,           ///< closures between other bodies than the odometry
  closure_gap,             ///< closures that the odometry contradicts
  information_order,       ///< blocks of rotation and translation exchanged
  information_indefinite,  ///< matrices that are not positive definite
  information_scale,       ///< stated covariances contradict the residuals
  nothing_moved,           ///< a correction without effect
  lever_arm,               ///< the reference is that of another body
  body_rotation            ///< the axes of the reference's body differ from the estimate's
};

/// Findings with a smaller confidence are not reported.
inline constexpr double kLeastConfidence = 0.25;

struct InputFinding {
  Fault fault{};
  std::string evidence;  ///< numbers that show the mistake
  std::string fix;       ///< what to do, as an option where there is one
  double confidence =
      0.0;             ///< 0..1: 1 - error after / error before the fix, where that is measured
  double value = 0.0;  ///< offset [s], ratio, or number of edges; see `evidence`
};

/// "time_offset": short name of a fault.
inline std::string fault_name(Fault fault) {
  // In the order of the enumerators.
  static constexpr std::array kNames{"time_offset",
                                     "stamp_unit",
                                     "repeated_stamps",
                                     "frame_indices",
                                     "clock_drift",
                                     "no_overlap",
                                     "missing_poses",
                                     "wrong_recording",
                                     "jumps",
                                     "constant_rotation",
                                     "quaternion_order",
                                     "conjugated",
                                     "inverted_poses",
                                     "axes",
                                     "angle_unit",
                                     "length_unit",
                                     "scale",
                                     "swapped",
                                     "closure_direction",
                                     "odometry_direction",
                                     "closure_rotation",
                                     "closure_unit",
                                     "closure_frame",
                                     "closure_gap",
                                     "information_order",
                                     "information_indefinite",
                                     "information_scale",
                                     "nothing_moved",
                                     "lever_arm",
                                     "body_rotation"};
  static_assert(kNames.size() == std::size_t{1} + static_cast<std::size_t>(Fault::body_rotation));
  return kNames.at(static_cast<std::size_t>(fault));
}

/// "time_offset: EVIDENCE; FIX (confidence 0.93)".
inline std::string text(const InputFinding& finding) {
  return fmt::format("{}: {}; {} (confidence {:.2f})",
                     fault_name(finding.fault),
                     finding.evidence,
                     finding.fix,
                     finding.confidence);
}

}  // namespace loopbench::metrics
