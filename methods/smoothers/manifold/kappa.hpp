/// The six readings of the article's kappa, whose unit it never gives.
#pragma once

#include <array>

#include "methods/smoothers/manifold/nodes.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::manifold {

/// turn_per_kf: angle between the steps [rad], the only one whose printed thresholds cut both runs
/// usefully. menger: 1 / radius through three nodes. dtheta_ds, dtheta_dt: that angle over the mean
/// step [1/m] or the mean time [rad/s]. analytic_spline: of the cubic spline [1/m].
/// rotation_per_kf: of the camera over both steps, halved [rad].
enum class Kappa { turn_per_kf, menger, dtheta_ds, dtheta_dt, analytic_spline, rotation_per_kf };
inline auto choices(Kappa) {
  return std::array{std::pair{"turn_per_kf", Kappa::turn_per_kf},
                    std::pair{"menger", Kappa::menger},
                    std::pair{"dtheta_ds", Kappa::dtheta_ds},
                    std::pair{"dtheta_dt", Kappa::dtheta_dt},
                    std::pair{"analytic_spline", Kappa::analytic_spline},
                    std::pair{"rotation_per_kf", Kappa::rotation_per_kf}};
}

/// space: as it is. plane: of the path seen from above, the article's xoy.
enum class Plane { space, plane };
inline auto choices(Plane) {
  return std::array{std::pair{"3d", Plane::space}, std::pair{"xy", Plane::plane}};
}

/// kappa at every node, 0 at the first and last. `poses` are the nodes with their attitude; only
/// rotation_per_kf looks at that, and it does not know planes. O(n).
std::vector<double> kappas(
    const Nodes& nodes, const Trajectory& poses, Kappa definition, Plane plane, const Vector3& up);

}  // namespace loopbench::manifold
