/// Quantities measured on an error transform: evo's pose relations, and Euler angles.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/numerics/euler.hpp"
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
inline std::string unit(Relation relation) {
  switch (relation) {
    case Relation::translation_part:
    case Relation::point_distance:
      return "m";
    case Relation::rotation_angle_deg:
    case Relation::rpy:
      return "deg";
    case Relation::rotation_angle_rad:
      return "rad";
    case Relation::point_distance_error_ratio:
      return "%";
    case Relation::full_transformation:
    case Relation::rotation_part:
    case Relation::usual:
      break;
  }
  return "1";
}

/// Value of the relation for E. Throws std::logic_error for usual, rpy and the point distances.
inline double measure(Relation relation, const Pose& E, AngleFormula formula) {
  // |R - I| = 2 sqrt(2) sin(angle / 2), computed from the quaternion without cancellation.
  const double square = 8.0 * E.rotation.vec().squaredNorm();
  switch (relation) {
    case Relation::full_transformation:
      return std::sqrt(square + E.translation.squaredNorm());
    case Relation::translation_part:
      return E.translation.norm();
    case Relation::rotation_part:
      return std::sqrt(square);
    case Relation::rotation_angle_deg:
      return kDegrees * rotation_angle(formula, E.rotation);
    case Relation::rotation_angle_rad:
      return rotation_angle(formula, E.rotation);
    default:
      throw std::logic_error("measure: " + to_text(relation) +
                             " needs more than the error transform");
  }
}

/// Value of the relation for E with the digits of files: evo's norms of E - I use a rotation that
/// is not orthonormal as it is. Throws as above.
inline double measure(Relation relation, const PoseMatrix& E, AngleFormula formula) {
  const double rotation = (E.linear() - Matrix3::Identity()).norm();
  if (relation == Relation::rotation_part) return rotation;
  if (relation == Relation::full_transformation)
    return std::hypot(rotation, E.translation().norm());
  return measure(relation, pose_of(E), formula);
}

/// Magnitudes of the Euler angles of many rotations [deg].
class Rpy {
 public:
  explicit Rpy(std::size_t size) {
    for (std::vector<double>& angle : degrees_) angle.resize(size);
  }

  void set(std::size_t i, const Rotation& rotation) {
    const auto [roll, pitch, yaw] = euler(rotation);
    degrees_[0][i] = kDegrees * std::abs(roll);
    degrees_[1][i] = kDegrees * std::abs(pitch);
    degrees_[2][i] = kDegrees * std::abs(yaw);
  }

  /// rotation roll, pitch, yaw [deg]. Moves the values out; call once.
  std::vector<Score> scores(int ddof) {
    return {{"rotation", "roll", "deg", statistics(std::move(degrees_[0]), ddof)},
            {"rotation", "pitch", "deg", statistics(std::move(degrees_[1]), ddof)},
            {"rotation", "yaw", "deg", statistics(std::move(degrees_[2]), ddof)}};
  }

 private:
  std::array<std::vector<double>, 3> degrees_;
};

}  // namespace loopbench::metrics
