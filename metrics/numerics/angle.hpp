/// Radians to the degrees that tables show.
#pragma once

#include <numbers>

namespace loopbench {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;  ///< [deg/rad]

}  // namespace loopbench
