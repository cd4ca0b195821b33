/// WGS 84 coordinates, and local ones in metres. Only here is GeographicLib.
#pragma once

#include <string>

#include "datasets/core/trajectory.hpp"

namespace loopbench {

/// Origin of local coordinates: x east, y north, z up.
struct GeodeticOrigin {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double height = 0.0;     ///< above the ellipsoid [m]
};

/// "WGS 84, local coordinates east, north, up at latitude 47.3, longitude 8.5, height 420 m"
std::string to_text(const GeodeticOrigin& origin);

/// Returns the rule that latitude, longitude [deg] and height [m] violate; empty: none.
std::string violated_degrees(const Vector3& position);

/// The first position of geodetic ones.
GeodeticOrigin origin_of(const Trajectory& geodetic);

/// Converts positions (latitude, longitude, height) to east, north and up of the origin. Rotations
/// stay as they are. Throws MissingPart if the build lacks GeographicLib. O(n).
Trajectory to_local(Trajectory geodetic, const GeodeticOrigin& origin);

}  // namespace loopbench
