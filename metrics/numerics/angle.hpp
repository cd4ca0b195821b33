/// Conversion from radians to degrees.
#pragma once

#include <numbers>

namespace loopbench::metrics {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;  ///< [deg/rad]

}  // namespace loopbench::metrics
