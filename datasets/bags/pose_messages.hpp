/// Deserialisation of messages that contain poses, from ROS 1 and CDR.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/messages.hpp"
#include "datasets/core/se3.hpp"

namespace loopbench {

/// A pose of `child` in `frame`; the quaternion as recorded, not normalised.
struct PoseMessage {
  std::int64_t nanoseconds = 0;  ///< of the message's header
  std::string frame;             ///< without leading '/'
  std::string child;             ///< "" for poses without child frame
  Pose frame_from_child;
  std::optional<Matrix6> covariance = {};  ///< order x y z, rotations about x y z
};

/// The poses of one message: several for Path and TF. Throws DamagedRecord. O(bytes).
std::vector<PoseMessage> decode(const BagTopic& topic, std::string_view message);

}  // namespace loopbench
