#include "metrics/doctor/finding.hpp"

#include <fmt/format.h>

namespace loopbench::metrics {

std::string fault_name(Fault fault) {
  switch (fault) {
    case Fault::time_offset:
      return "time_offset";
    case Fault::stamp_unit:
      return "stamp_unit";
    case Fault::no_overlap:
      return "no_overlap";
    case Fault::constant_rotation:
      return "constant_rotation";
    case Fault::quaternion_order:
      return "quaternion_order";
    case Fault::conjugated:
      return "conjugated";
    case Fault::inverted_poses:
      return "inverted_poses";
    case Fault::axes:
      return "axes";
    case Fault::angle_unit:
      return "angle_unit";
    case Fault::length_unit:
      return "length_unit";
    case Fault::scale:
      return "scale";
    case Fault::swapped:
      return "swapped";
    case Fault::closure_direction:
      return "closure_direction";
    case Fault::closure_gap:
      return "closure_gap";
    case Fault::information_order:
      return "information_order";
    case Fault::information_scale:
      return "information_scale";
    case Fault::nothing_moved:
      return "nothing_moved";
    case Fault::edge_covariance:
      return "edge_covariance";
    case Fault::lever_arm:
      return "lever_arm";
    case Fault::body_rotation:
      return "body_rotation";
  }
  return "unknown";
}

std::string text(const InputFinding& finding) {
  return fmt::format("{}: {}; {} (confidence {:.2f})",
                     fault_name(finding.fault),
                     finding.evidence,
                     finding.fix,
                     finding.confidence);
}

}  // namespace loopbench::metrics
