/// Trajectories from bags.
#pragma once

#include <string>
#include <vector>

#include "datasets/bags/bag_name.hpp"
#include "datasets/bags/messages.hpp"
#include "datasets/bags/pose_messages.hpp"

namespace loopbench {

struct BagTrajectory {
  std::string topic;
  std::vector<PoseMessage> poses;  ///< sorted by stamp; valid, with unit quaternions
  double off_unit = 0.0;           ///< maximum | |q| - 1 | before normalisation
  std::string damage;              ///< what is missing or was skipped; empty: nothing
};

/// Reads one trajectory: of a topic (of a Path topic, the last path), or between two frames of the
/// TF tree (all TF topics; those that end in "static" hold at all times). Poses that are not finite
/// or have a zero quaternion are skipped, and `damage` states their number. Throws InputError: no
/// such topic (with those that exist), several child frames, no poses. O(bytes + n log n).
BagTrajectory read_bag_trajectory(const BagName& name);

/// All topics with poses except TF, sorted by name; and the damage. O(bytes).
BagSummary bag_topics(const std::string& file);

}  // namespace loopbench
