/// Names of trajectories in bags: bag:FILE, bag:FILE#/topic, bag:FILE#tf:PARENT.CHILD.
#pragma once

#include <string>

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

}  // namespace loopbench
