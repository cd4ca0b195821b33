#include "metrics/doctor/position_checks.hpp"

#include <vector>

namespace loopbench::metrics {

Diagnosis diagnosis_of_positions(Trajectory reference,
                                 Trajectory estimate,
                                 const std::string& reference_name,
                                 const std::string& estimate_name,
                                 bool has_stamps) {
  for (Trajectory* poses : {&reference, &estimate}) {
    if (!lacks_rotations(*poses)) continue;
    for (StampedPose& pose : *poses) pose.world_from_body.rotation = Rotation::Identity();
  }
  Diagnosis out = diagnosis(reference, estimate, reference_name, estimate_name, has_stamps);
  std::erase_if(out.findings, [](const InputFinding& finding) {
    return finding.fault == Fault::constant_rotation || finding.fault == Fault::swapped;
  });
  return out;
}

}  // namespace loopbench::metrics
