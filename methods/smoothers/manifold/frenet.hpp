/// Equations (2) to (7), repaired: the frame {T, N, B} along a curve, its curvature and torsion.
///
/// Printed, T is not unit and B and N are defined by each other. Here T = S' / |S'|,
/// B = S' x S'' / |S' x S''|, N = B x T; kappa is what (6) and (7) print as tau.
#pragma once

#include <optional>
#include <span>

#include "methods/smoothers/manifold/nodes.hpp"

namespace loopbench::manifold {

struct Triad {
  Vector3 T, N, B;  ///< unit, right-handed
};

/// S'' less its part along S', over |S'|^2: points to the centre of curvature, length kappa [1/m].
inline Vector3 curvature_vector(const Vector3& first, const Vector3& second) {
  return (second - first.dot(second) / first.squaredNorm() * first) / first.squaredNorm();
}

/// |S' x S''| / |S'|^3 [1/m]; 0 when standing.
double curvature(const Vector3& first, const Vector3& second);

/// (S' x S'') . S''' / |S' x S''|^2 [1/m], positive for a right-handed screw; nothing where the
/// frame is undefined.
std::optional<double> torsion(const Vector3& first, const Vector3& second, const Vector3& third);

/// The Frenet frame, or nothing where it is undefined: standing, |S'| = 0, or straight,
/// |S' x S''| <= 1e-9 |S'| |S''| and likewise when S'' vanishes.
std::optional<Triad> frenet(const Vector3& first, const Vector3& second);

/// Menger's: one over the radius of the circle through three points [1/m]; 0 if two coincide.
double discrete_curvature(const Vector3& a, const Vector3& b, const Vector3& c);

/// Angle from the plane of a, b, c to that of b, c, d over |c - b| [1/m], with the sign of the
/// torsion; nothing where three neighbours lie on a line.
std::optional<double> discrete_torsion(const Vector3& a,
                                       const Vector3& b,
                                       const Vector3& c,
                                       const Vector3& d);

/// Rotation-minimising frames along points with unit tangents, carried on from `start` by double
/// reflection: defined where Frenet's is not, turning no more than the curve makes them.
/// T of `start` is tangents[0]. Source: Wang, Juettler, Zheng, Liu, ACM TOG 27(1) 2008. O(n).
std::vector<Triad> rotation_minimising(std::span<const Vector3> points,
                                       std::span<const Vector3> tangents,
                                       const Triad& start);

/// Any triad around a unit tangent, for starting where Frenet is undefined.
Triad any_triad(const Vector3& tangent);

}  // namespace loopbench::manifold
