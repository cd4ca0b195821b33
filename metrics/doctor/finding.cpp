#include "metrics/doctor/finding.hpp"

#include <fmt/format.h>

#include <map>

namespace loopbench::metrics {

std::string fault_name(Fault fault) {
  static const std::map<Fault, std::string> kNames{
      {Fault::time_offset, "time_offset"},
      {Fault::stamp_unit, "stamp_unit"},
      {Fault::frame_indices, "frame_indices"},
      {Fault::clock_drift, "clock_drift"},
      {Fault::no_overlap, "no_overlap"},
      {Fault::missing_poses, "missing_poses"},
      {Fault::wrong_recording, "wrong_recording"},
      {Fault::jumps, "jumps"},
      {Fault::constant_rotation, "constant_rotation"},
      {Fault::quaternion_order, "quaternion_order"},
      {Fault::conjugated, "conjugated"},
      {Fault::inverted_poses, "inverted_poses"},
      {Fault::axes, "axes"},
      {Fault::angle_unit, "angle_unit"},
      {Fault::length_unit, "length_unit"},
      {Fault::scale, "scale"},
      {Fault::swapped, "swapped"},
      {Fault::closure_direction, "closure_direction"},
      {Fault::odometry_direction, "odometry_direction"},
      {Fault::closure_rotation, "closure_rotation"},
      {Fault::closure_unit, "closure_unit"},
      {Fault::closure_frame, "closure_frame"},
      {Fault::closure_gap, "closure_gap"},
      {Fault::information_order, "information_order"},
      {Fault::information_scale, "information_scale"},
      {Fault::edge_covariance, "edge_covariance"},
      {Fault::nothing_moved, "nothing_moved"},
      {Fault::lever_arm, "lever_arm"},
      {Fault::body_rotation, "body_rotation"}};
  return kNames.at(fault);
}

std::string text(const InputFinding& finding) {
  return fmt::format("{}: {}; {} (confidence {:.2f})",
                     fault_name(finding.fault),
                     finding.evidence,
                     finding.fix,
                     finding.confidence);
}

}  // namespace loopbench::metrics
