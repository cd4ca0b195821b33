/// Equations (2) to (7), corrected: the frame {T, N, B} along a curve, its curvature and torsion.
///
/// As printed, T is not a unit vector and B and N are defined by each other. Here T = S' / |S'|, B
/// = S' x S'' / |S' x S''|, N = B x T; kappa is printed as tau in (6) and (7).
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::methods::manifold {

struct Triad {
  Vector3 T, N, B;  ///< unit vectors, right-handed
};

/// Component of S'' perpendicular to S' over |S'|^2: points to the centre of curvature, length
/// kappa [1/m].
inline Vector3 curvature_vector(const Vector3& first, const Vector3& second) {
  return (second - first.dot(second) / first.squaredNorm() * first) / first.squaredNorm();
}

/// |S' x S''| / |S'|^3 [1/m]; 0 at rest.
double curvature(const Vector3& first, const Vector3& second);

/// (S' x S'') . S''' / |S' x S''|^2 [1/m], positive for a right-handed screw; nullopt where the
/// frame is undefined.
std::optional<double> torsion(const Vector3& first, const Vector3& second, const Vector3& third);

/// Returns the Frenet frame, or nullopt where it is undefined: at rest, |S'| = 0, or on a straight
/// line, |S' x S''| <= 1e-9 |S'| |S''|.
std::optional<Triad> frenet(const Vector3& first, const Vector3& second);

/// Menger curvature: one over the radius of the circle through three points [1/m]; 0 if two
/// coincide.
double discrete_curvature(const Vector3& a, const Vector3& b, const Vector3& c);

/// Angle from the plane of a, b, c to that of b, c, d over |c - b| [1/m], with the sign of the
/// torsion; nullopt where three neighbours are collinear.
std::optional<double> discrete_torsion(const Vector3& a,
                                       const Vector3& b,
                                       const Vector3& c,
                                       const Vector3& d);

/// Rotation-minimising frames along points with unit tangents, propagated from `start` by double
/// reflection. They are defined where the Frenet frame is not, with the least rotation about the
/// tangent. T of `start` is tangents[0]. Source: Wang, Juettler, Zheng, Liu, ACM TOG 27(1) 2008.
/// O(n).
std::vector<Triad> rotation_minimising(std::span<const Vector3> points,
                                       std::span<const Vector3> tangents,
                                       const Triad& start);

/// Returns an arbitrary triad with the given unit tangent, as a start where Frenet is undefined.
Triad arbitrary_triad(const Vector3& tangent);

}  // namespace loopbench::methods::manifold
