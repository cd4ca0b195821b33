/// A likely mistake in the input of an evaluation.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace loopbench::metrics {

/// Short names of mistakes, as they are printed.
struct Fault {
  using Name = std::string_view;
  static constexpr Name time_offset = "time_offset";
  static constexpr Name stamp_unit = "stamp_unit";  ///< milliseconds to nanoseconds for seconds
  static constexpr Name repeated_stamps = "repeated_stamps";      ///< of the pose before
  static constexpr Name frame_indices = "frame_indices";          ///< frame numbers for seconds
  static constexpr Name clock_drift = "clock_drift";              ///< clocks of different rates
  static constexpr Name no_overlap = "no_overlap";                ///< no common time
  static constexpr Name missing_poses = "missing_poses";          ///< large gaps in the estimate
  static constexpr Name wrong_recording = "wrong_recording";      ///< files of different recordings
  static constexpr Name jumps = "jumps";                          ///< positions jump
  static constexpr Name constant_rotation = "constant_rotation";  ///< one file has no rotations
  static constexpr Name quaternion_order = "quaternion_order";
  static constexpr Name conjugated = "conjugated";          ///< inverted rotations, not positions
  static constexpr Name inverted_poses = "inverted_poses";  ///< world and body are exchanged
  static constexpr Name axes = "axes";                      ///< mirrored or permuted axes
  static constexpr Name angle_unit = "angle_unit";          ///< degrees for radians, or the reverse
  static constexpr Name length_unit = "length_unit";  ///< millimetres or centimetres for metres
  static constexpr Name scale = "scale";              ///< no metric scale, aligned without scale
  static constexpr Name swapped = "swapped";          ///< reference and estimate are exchanged
  static constexpr Name closure_direction = "closure_direction";    ///< from `to` to `from`
  static constexpr Name odometry_direction = "odometry_direction";  ///< the same for odometry
  static constexpr Name closure_rotation = "closure_rotation";    ///< quaternion order, angle unit
  static constexpr Name closure_unit = "closure_unit";            ///< not the unit of the odometry
  static constexpr Name closure_frame = "closure_frame";          ///< not the body of the odometry
  static constexpr Name closure_gap = "closure_gap";              ///< contradicted by the odometry
  static constexpr Name information_order = "information_order";  ///< blocks exchanged
  static constexpr Name information_indefinite = "information_indefinite";
  static constexpr Name information_scale = "information_scale";  ///< contradicts residuals
  static constexpr Name lever_arm = "lever_arm";          ///< the reference is of another body
  static constexpr Name body_rotation = "body_rotation";  ///< other axes of the body
};

/// Findings with a smaller confidence are not reported.
inline constexpr double kLeastConfidence = 0.25;

struct InputFinding {
  Fault::Name fault;
  std::string evidence;     ///< numbers that show the mistake
  std::string fix;          ///< what to do, as an option where there is one
  double confidence = 0.0;  ///< 0..1: where measured, 1 - error after / error before the fix
  double value = 0.0;       ///< offset [s], ratio, or number of edges; see `evidence`
};

/// "time_offset: EVIDENCE; FIX (confidence 0.93)".
inline std::string text(const InputFinding& finding) {
  return fmt::format("{}: {}; {} (confidence {:.2f})",
                     finding.fault,
                     finding.evidence,
                     finding.fix,
                     finding.confidence);
}

}  // namespace loopbench::metrics
