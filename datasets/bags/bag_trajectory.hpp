/// Trajectories in bags, named bag:FILE, bag:FILE#/topic, bag:FILE#tf:PARENT.CHILD.
#pragma once

#include <string>
#include <vector>

#include "datasets/bags/messages.hpp"

namespace loopbench {

struct BagName {
  std::string file;
  std::string topic = {};  ///< "/odom", or "tf:map.base_link"; empty: the only one in the file
};

/// Whether the name begins with "bag:".
bool names_bag(const std::string& name);

/// Splits the name, with or without the prefix. The part after the last '#' is the topic.
BagName bag_name(const std::string& name);

/// The inverse: "bag:FILE#TOPIC".
std::string to_text(const BagName& name);

/// The file that `name` refers to: FILE of a bag, otherwise `name` itself.
std::string file_of(const std::string& name);

struct BagTrajectory {
  std::string topic;
  /// Sorted by stamp; valid, with unit quaternions, or all positions without rotation.
  std::vector<PoseMessage> poses;
  bool is_geodetic = false;  ///< positions are latitude, longitude [deg] and height [m]
  double off_unit = 0.0;     ///< maximum | |q| - 1 | before normalisation
  std::string damage;        ///< what is missing or was skipped; empty: nothing
};

/// Reads one trajectory: of a topic (of a Path topic, the last path), or between two frames of the
/// TF tree (all TF topics; those that end in "static" hold at all times). Poses that are not finite
/// or have a zero quaternion are skipped, and `damage` states their number. Throws InputError: no
/// such topic (with those that exist), several child frames, no poses. O(bytes + n log n).
BagTrajectory read_bag_trajectory(const BagName& name);

/// All topics with poses except TF, sorted by name; and the damage. O(bytes).
BagSummary bag_topics(const std::string& file);

}  // namespace loopbench
