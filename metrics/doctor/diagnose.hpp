/// All checks of a pair of trajectories, in an order in which one mistake does not hide another.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/trajectory.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct Diagnosis {
  std::vector<InputFinding> findings;
  std::vector<std::string> unchecked;  ///< "CHECKS: REASON"
  bool has_checked = false;            ///< at least one check of frames, units or time was possible
};

/// Names are used by check_swapped() only. Stamps are corrected first, then conventions, units and
/// bodies are compared with the corrected stamps, one repair after the other. What is found is
/// tested on poses that were not used to estimate it. If no repair makes the files agree, they are
/// of different recordings. Constant rotations of files without rotations are no finding.
/// `has_stamps`: false if the stamps of either are generated, so that there is no time offset.
/// O(1e6).
Diagnosis diagnosis(const Trajectory& reference,
                    const Trajectory& estimate,
                    const std::string& reference_name,
                    const std::string& estimate_name,
                    bool has_stamps = true);

}  // namespace loopbench::metrics
