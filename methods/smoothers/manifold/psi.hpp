/// Step 5: psi, the "optimal tangent vector" among candidates psi_1..psi_i.
///
/// The article defines neither the candidates, nor the cost, nor the use. psi does not change
/// orientations.
#pragma once

#include <array>
#include <span>

#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// Use of psi: none, or as the spline's direction at the ends of segments.
enum class PsiUse { none, boundary_tangent };
inline auto choices(PsiUse) {
  return std::array{std::pair{"none", PsiUse::none},
                    std::pair{"boundary_tangent", PsiUse::boundary_tangent}};
}

/// discrete: the best of the candidates. frechet: the Frechet mean of the chords on the sphere.
enum class PsiMean { discrete, frechet };
inline auto choices(PsiMean) {
  return std::array{std::pair{"discrete", PsiMean::discrete},
                    std::pair{"frechet", PsiMean::frechet}};
}

/// Unit direction and its weight.
struct WeightedDirection {
  Vector3 direction;
  double weight;
};

/// Weighted sum of squared angles to the directions [rad^2].
double dispersion(const Vector3& psi, std::span<const WeightedDirection> chords);

/// Returns the unit vector that minimises dispersion(): five steps of gradient descent on the
/// sphere (Karcher, step size 1) from the weighted sum. It is unique for directions within an open
/// hemisphere.
Vector3 frechet_mean(std::span<const WeightedDirection> directions);

/// Chords around a node, up to `half` steps on each side, with the weight exp(-|t| / 1 s), where t
/// is the time from the node to the middle of the chord. Steps of zero length are omitted.
std::vector<WeightedDirection> chords_around(const Nodes& nodes,
                                             std::size_t node,
                                             std::size_t half);

/// Candidate directions: backward, forward and central chord, principal axis of the surrounding
/// nodes, and tangent of the spline. Unit vectors, oriented along the displacement. Undefined
/// directions are omitted.
std::vector<Vector3> candidates(const Nodes& nodes,
                                const NodeSpline& spline,
                                std::size_t node,
                                std::size_t half);

/// psi at a node; the zero vector where all surrounding nodes are at rest.
Vector3 optimal_tangent(
    const Nodes& nodes, const NodeSpline& spline, std::size_t node, std::size_t half, PsiMean mean);

/// Velocities at the ends of segments: psi times the mean speed over the two adjacent steps.
/// O(nodes).
std::vector<Clamp> segment_end_velocities(const Nodes& nodes,
                                          const NodeSpline& spline,
                                          std::span<const NodeRange> segments,
                                          std::size_t half,
                                          PsiMean mean);

}  // namespace loopbench::methods::manifold
