#include "datasets/columns/geodetic.hpp"

#include <fmt/format.h>

#ifdef LOOPBENCH_HAS_GEOGRAPHICLIB
#include <GeographicLib/LocalCartesian.hpp>
#endif

#include "datasets/core/error.hpp"

namespace loopbench {

#ifndef LOOPBENCH_HAS_GEOGRAPHICLIB
namespace {

[[noreturn]] void lack_geographiclib() {
  throw MissingPart(
      "this build cannot convert latitude and longitude: install the package libgeographiclib-dev "
      "and build again");
}

}  // namespace
#endif

std::string to_text(const GeodeticOrigin& origin) {
  return fmt::format(
      "WGS 84, local coordinates east, north, up at latitude {:.9g}, longitude {:.9g}, height "
      "{:.6g} m",
      origin.latitude,
      origin.longitude,
      origin.height);
}

std::string violated_degrees(const Vector3& position) {
  constexpr const char* kMetres = " (coordinates in metres have columns x, y, z)";
  if (!(std::abs(position.x()) <= 90.0)) {
    return fmt::format("latitude is {:.9g}, expected -90 to 90 degrees{}", position.x(), kMetres);
  }
  if (!(position.y() >= -180.0 && position.y() <= 360.0)) {
    return fmt::format(
        "longitude is {:.9g}, expected -180 to 360 degrees{}", position.y(), kMetres);
  }
  constexpr double kHighest = 1e7;  // [m]
  if (!(std::abs(position.z()) <= kHighest)) {
    return fmt::format("height is {:.9g}, expected at most {:g} m", position.z(), kHighest);
  }
  return "";
}

GeodeticOrigin origin_of(const Trajectory& geodetic) {
  const Vector3& first = geodetic.front().world_from_body.translation;
  return {first.x(), first.y(), first.z()};
}

Trajectory to_local([[maybe_unused]] Trajectory geodetic,
                    [[maybe_unused]] const GeodeticOrigin& origin) {
#ifdef LOOPBENCH_HAS_GEOGRAPHICLIB
  const GeographicLib::LocalCartesian local(origin.latitude, origin.longitude, origin.height);
  for (auto& [stamp, pose] : geodetic) {
    const Vector3 from = pose.translation;
    Vector3& to = pose.translation;
    local.Forward(from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
  }
  return geodetic;
#else
  lack_geographiclib();
#endif
}

}  // namespace loopbench
