/// What the odometry of a problem needs so that measurements can be compared with it.
#pragma once

#include <string>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

/// Returns why the odometry cannot be compared with closures or anchors, or an empty text: edges
/// that change the scale, keyframes that are not connected, or odometry between fewer than half of
/// them. O(keyframes + edges).
std::string why_no_odometry(const Problem& problem);

}  // namespace loopbench::methods
