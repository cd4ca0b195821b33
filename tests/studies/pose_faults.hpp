/// Faults planted in trajectories with random parameters, for doctor_rates.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/studies/recordings.hpp"

namespace loopbench {

struct PlantedFault {
  std::string name;
  std::vector<std::string> expected;  ///< any of these names of findings is correct
  /// Returns whether the recording has the fault afterwards. `others`: for files of another one.
  std::function<bool(Recording&, std::mt19937&, const std::vector<Recording>& others)> plant;
  bool can_be_small = false;  ///< see exceeds_errors()
};

/// Whether short motions of the estimate change by more than their errors are (in the median).
bool exceeds_errors(const Recording& right, const Recording& planted);

std::vector<PlantedFault> pose_faults();

}  // namespace loopbench
