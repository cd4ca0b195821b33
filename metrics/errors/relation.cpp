#include "metrics/errors/relation.hpp"

#include <stdexcept>

#include "metrics/numerics/angle.hpp"

namespace loopbench::metrics {

std::string unit(Relation relation) {
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

double measure(Relation relation, const Pose& E, AngleFormula formula) {
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

}  // namespace loopbench::metrics
