/// A likely mistake in the input of an evaluation.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace loopbench::metrics {

/// Short names of mistakes, as they are printed.
struct Fault {
  using Name = std::string_view;
  // Of two trajectories.
  static constexpr Name time_offset =
      "time_offset";                                ///< or a shift of rows of files without stamps
  static constexpr Name stamp_unit = "stamp_unit";  ///< milliseconds to nanoseconds for seconds
  static constexpr Name no_overlap = "no_overlap";  ///< no common time, frame numbers for seconds
  static constexpr Name missing_poses = "missing_poses";      ///< large gaps, dropped frames
  static constexpr Name wrong_recording = "wrong_recording";  ///< files of different recordings
  static constexpr Name row_order = "row_order";              ///< rows of files sorted as text
  static constexpr Name relative_poses = "relative_poses";    ///< motions from row to row
  static constexpr Name degrees = "degrees";                  ///< latitude and longitude as x and y
  static constexpr Name sheared = "sheared";                  ///< axes have different units
  static constexpr Name jumps = "jumps";                      ///< positions jump
  static constexpr Name new_map = "new_map";            ///< frame changes, restart at the origin
  static constexpr Name frozen = "frozen";              ///< the same pose for seconds
  static constexpr Name scale_change = "scale_change";  ///< once, at a row
  static constexpr Name constant_rotation = "constant_rotation";  ///< one file has no rotations
  static constexpr Name quaternion_order = "quaternion_order";
  static constexpr Name inverted_poses = "inverted_poses";  ///< or rotations or positions alone
  static constexpr Name axes = "axes";                      ///< permuted axes of the positions
  static constexpr Name mirrored = "mirrored";              ///< left-handed coordinates
  static constexpr Name other_body = "other_body";          ///< rotated body, lever arm
  static constexpr Name scale = "scale";                    ///< unit of lengths, no metric scale
  static constexpr Name swapped = "swapped";                ///< reference and estimate exchanged
  // Of loops and graphs.
  static constexpr Name loop_stamps = "loop_stamps";                ///< match no pose
  static constexpr Name closure_direction = "closure_direction";    ///< from `to` to `from`
  static constexpr Name closure_convention = "closure_convention";  ///< order of quaternions, frame
  static constexpr Name placeholders = "placeholders";    ///< identities that were not measured
  static constexpr Name closure_gap = "closure_gap";      ///< contradicted by odometry or others
  static constexpr Name odometry_step = "odometry_step";  ///< contradicted by the closures
  static constexpr Name information = "information";  ///< contradicts gaps, not positive definite
};

/// Findings with a smaller confidence are not reported.
inline constexpr double kLeastConfidence = 0.25;

struct InputFinding {
  Fault::Name fault;
  std::string evidence;            ///< numbers that show the mistake
  std::string fix;                 ///< what to do, as an option where there is one
  double confidence = 0.0;         ///< 0..1: where measured, 1 - error after / error before the fix
  double value = 0.0;              ///< offset [s], ratio, or number of edges; see `evidence`
  bool has_frame_numbers = false;  ///< the estimate's stamps are frame numbers
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
