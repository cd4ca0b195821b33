/// Quantities measured on an error transform: evo's pose relations, and Euler angles.
#pragma once

#include <string>

#include "metrics/pairing/motion.hpp"

namespace loopbench::metrics {

enum class Relation {
  usual,                ///< the metric's default scores
  full_transformation,  ///< Frobenius norm of E - I, which mixes metres and radians
  translation_part,     ///< length of E's translation [m]
  rotation_part,        ///< Frobenius norm of R - I
  rotation_angle_deg,   ///< [deg]
  rotation_angle_rad,   ///< [rad]
  point_distance,       ///< absolute: distance of points; relative: difference of distances [m]
  point_distance_error_ratio,  ///< relative only: point_distance over the reference's distance [%]
  rpy,                         ///< roll, pitch and yaw of E, magnitudes [deg]
};
inline auto choices(Relation) {
  return std::array{std::pair{"usual", Relation::usual},
                    std::pair{"full_transformation", Relation::full_transformation},
                    std::pair{"translation_part", Relation::translation_part},
                    std::pair{"rotation_part", Relation::rotation_part},
                    std::pair{"rotation_angle_deg", Relation::rotation_angle_deg},
                    std::pair{"rotation_angle_rad", Relation::rotation_angle_rad},
                    std::pair{"point_distance", Relation::point_distance},
                    std::pair{"point_distance_error_ratio", Relation::point_distance_error_ratio},
                    std::pair{"rpy", Relation::rpy}};
}

/// "m", "deg", "rad", "%", or "1" for norms that mix units.
std::string unit(Relation relation);

/// Value of the relation for E. Throws std::logic_error for usual, rpy and the point distances.
double measure(Relation relation, const Pose& E, AngleFormula formula);

}  // namespace loopbench::metrics
