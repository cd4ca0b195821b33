/// Writing of trajectories as ROS 2 messages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/core/se3.hpp"
#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// An MCAP file with one topic of geometry_msgs/msg/PoseStamped, or of PoseWithCovarianceStamped if
/// there is a covariance for each pose (CDR, little-endian), in the frame `map`, with its schema,
/// one uncompressed chunk and its index. `nanoseconds` has a stamp for each pose. Throws InputError
/// for stamps that ROS 2 cannot represent: before 1970 or after January 2038. O(n).
std::string mcap_of(const Trajectory& poses,
                    const std::vector<std::int64_t>& nanoseconds,
                    const std::string& topic,
                    const std::vector<Matrix6>& covariances = {});

}  // namespace loopbench
