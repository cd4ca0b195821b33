/// Candidate corrections of a pair of trajectories.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metrics/doctor/agreement.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

struct Repair {
  Fault fault{};
  std::string what;    ///< "quaternions of the estimate in the order w x y z"
  std::string fix;     ///< a command or an option
  double value = 0.0;  ///< see InputFinding::value
  /// Subtracted from the gain in Agreement::cost(): of two repairs that fit alike, the simpler one
  /// is chosen.
  double penalty = 0.0;
  std::function<void(CommonPoses&)> apply;
};

/// Estimates the parameters of a repair from poses; nullopt if these do not suggest it.
using Proposal = std::function<std::optional<Repair>(const CommonPoses&)>;

/// Order and sign of quaternions, inverted poses, axes, units of angles and lengths, scale,
/// rotation and lever arm of the body.
const std::vector<Proposal>& proposals();

/// A repair that improves the agreement on poses that it was not fitted to.
struct Proven {
  Repair repair;  ///< with parameters from all poses
  Improvement improvement;
};

/// The repair with the largest gain, if it reduces the sum of errors clearly and at least one error
/// by 40 %; nullopt if there is none, or if the poses agree. O(n).
std::optional<Proven> best_repair(const CommonPoses& poses);

}  // namespace loopbench::metrics
