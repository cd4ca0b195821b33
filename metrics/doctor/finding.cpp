#include "metrics/doctor/finding.hpp"

#include <fmt/format.h>

#include <array>

namespace loopbench::metrics {

std::string fault_name(Fault fault) {
  // In the order of the enumerators.
  static constexpr std::array kNames{"time_offset",
                                     "stamp_unit",
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
                                     "information_scale",
                                     "nothing_moved",
                                     "lever_arm",
                                     "body_rotation"};
  static_assert(kNames.size() == std::size_t{1} + static_cast<std::size_t>(Fault::body_rotation));
  return kNames.at(static_cast<std::size_t>(fault));
}

std::string text(const InputFinding& finding) {
  return fmt::format("{}: {}; {} (confidence {:.2f})",
                     fault_name(finding.fault),
                     finding.evidence,
                     finding.fix,
                     finding.confidence);
}

}  // namespace loopbench::metrics
