/// Step 5: psi, the "optimal tangent vector" among candidates psi_1..psi_i.
///
/// The article gives neither candidates, nor a cost, nor a use; design section 6 does. It may not
/// alter orientations.
#pragma once

#include <array>
#include <span>

#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::manifold {

/// none, or the spline's direction where a segment begins or ends.
enum class PsiUse { none, boundary_tangent };
inline auto choices(PsiUse) {
  return std::array{std::pair{"none", PsiUse::none},
                    std::pair{"boundary_tangent", PsiUse::boundary_tangent}};
}

/// discrete: the best of the candidates. frechet: the mean of the chords on the sphere.
enum class PsiMean { discrete, frechet };
inline auto choices(PsiMean) {
  return std::array{std::pair{"discrete", PsiMean::discrete},
                    std::pair{"frechet", PsiMean::frechet}};
}

/// A unit direction and what it counts for.
struct WeightedDirection {
  Vector3 direction;
  double weight;
};

/// Sum of weights times squared angles to the directions [rad^2].
double spread(const Vector3& psi, std::span<const WeightedDirection> chords);

/// The unit vector that makes `spread` least: five Newton steps on the sphere (Karcher's, step 1)
/// from the weighted sum. Directions within an open half sphere have just one.
Vector3 frechet_mean(std::span<const WeightedDirection> directions);

/// The chords around a node, up to `half` steps on each side, weighted exp(-|t| / 1 s) by the time
/// from the node to the middle of the chord. Steps without length are left out.
std::vector<WeightedDirection> chords_around(const Nodes& nodes,
                                             std::size_t node,
                                             std::size_t half);

/// Backward, forward and central chord, the axis of most spread of the nodes around, and the
/// spline's tangent; unit, along the displacement. Those without a direction are left out.
std::vector<Vector3> candidates(const Nodes& nodes,
                                const NodeSpline& spline,
                                std::size_t node,
                                std::size_t half);

/// psi at a node; the zero vector where all around stands still.
Vector3 optimal_tangent(
    const Nodes& nodes, const NodeSpline& spline, std::size_t node, std::size_t half, PsiMean mean);

/// Where segments begin and end: psi times the mean speed over the steps on either side. O(nodes).
std::vector<Clamp> clamps(const Nodes& nodes,
                          const NodeSpline& spline,
                          std::span<const NodeRange> segments,
                          std::size_t half,
                          PsiMean mean);

}  // namespace loopbench::manifold
