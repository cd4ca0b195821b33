/// Candidate corrections of a pair of trajectories.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct Repair {
  Fault::Name fault;
  std::string what;    ///< "quaternions of the estimate in the order w x y z"
  std::string fix;     ///< a command or an option
  double value = 0.0;  ///< see InputFinding::value
  /// Subtracted from the gain in Agreement::cost(): of two repairs that fit alike, the simpler one
  /// is chosen.
  double penalty = 0.0;
  std::function<void(Paired&)> apply;
};

/// A repair that improves the agreement on poses that it was not fitted to.
struct Proven {
  Repair repair;  ///< with parameters from all poses
  Improvement improvement;
};

/// Of order and sign of quaternions, inverted poses, axes, units of lengths, scale, rotation and
/// lever arm of the body, the repair with the largest gain, if it reduces the sum of errors clearly
/// and at least one error by a quarter; nullopt if there is none, or if the poses agree. O(n).
std::optional<Proven> best_repair(const Paired& poses);

}  // namespace loopbench::metrics
