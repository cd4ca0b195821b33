/// Curvature of a curve, analytic and through three points.
#pragma once

#include "datasets/core/so3.hpp"

namespace loopbench::methods::manifold {

/// Component of S'' perpendicular to S' over |S'|^2: points to the centre of curvature, length
/// kappa [1/m].
inline Vector3 curvature_vector(const Vector3& first, const Vector3& second) {
  return (second - first.dot(second) / first.squaredNorm() * first) / first.squaredNorm();
}

/// |S' x S''| / |S'|^3 [1/m], equation (6); 0 at rest.
inline double curvature(const Vector3& first, const Vector3& second) {
  const double speed = first.norm();
  return speed > 0.0 ? first.cross(second).norm() / (speed * speed * speed) : 0.0;
}

/// Menger curvature: one over the radius of the circle through three points [1/m]; 0 if two
/// coincide.
inline double discrete_curvature(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a;
  const Vector3 bc = c - b;
  const double sides = ab.norm() * bc.norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * ab.cross(bc).norm() / sides : 0.0;
}

}  // namespace loopbench::methods::manifold
