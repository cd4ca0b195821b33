/// Six interpretations of the article's kappa, whose unit it does not state.
#pragma once

#include <array>

#include "methods/smoothers/manifold/nodes.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold {

/// turn_per_kf: angle between consecutive steps [rad]; the only one whose printed thresholds
/// segment both sequences usefully. menger: 1 / radius of the circle through three nodes [1/m].
/// dtheta_ds, dtheta_dt: the angle over the mean step [1/m] or the mean duration [rad/s].
/// analytic_spline: curvature of the cubic spline [1/m]. rotation_per_kf: half the camera rotation
/// over both steps [rad].
enum class Kappa { turn_per_kf, menger, dtheta_ds, dtheta_dt, analytic_spline, rotation_per_kf };
inline auto choices(Kappa) {
  return std::array{std::pair{"turn_per_kf", Kappa::turn_per_kf},
                    std::pair{"menger", Kappa::menger},
                    std::pair{"dtheta_ds", Kappa::dtheta_ds},
                    std::pair{"dtheta_dt", Kappa::dtheta_dt},
                    std::pair{"analytic_spline", Kappa::analytic_spline},
                    std::pair{"rotation_per_kf", Kappa::rotation_per_kf}};
}

/// space: the path in space. plane: the path projected along the up axis, the article's xoy plane.
enum class CurveSpace { space, plane };
inline auto choices(CurveSpace) {
  return std::array{std::pair{"3d", CurveSpace::space}, std::pair{"xy", CurveSpace::plane}};
}

/// Returns kappa at every node, 0 at the first and last. `poses` are the nodes with their rotation,
/// used by rotation_per_kf only, which ignores `plane`. O(n).
std::vector<double> kappas(const Nodes& nodes,
                           const Trajectory& poses,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up);

}  // namespace loopbench::methods::manifold
