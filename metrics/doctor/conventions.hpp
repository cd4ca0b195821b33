/// Conventions of poses that files mix up, as functions that repair poses.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/core/pose.hpp"
#include "metrics/doctor/finding.hpp"

namespace loopbench::metrics {

using PoseChange = std::function<Pose(const Pose&)>;

struct Convention {
  Fault::Name fault;     ///< in a trajectory
  std::string what;      ///< "inverting the poses"; the name of the file follows
  std::string option;    ///< of `traj transform`
  double unusual = 0.0;  ///< 0: common mistakes, otherwise number of signs and axes that it changes
  PoseChange change;
};

/// Orders of quaternions, inverted poses, left-handed coordinates, and the signed permutations of
/// axes: all 47 of positions, or the 23 rotations of the body of closures.
std::vector<Convention> conventions(bool of_closures);

}  // namespace loopbench::metrics
