/// Whether the stated covariances of an estimate agree with its errors.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// The alignment after which errors are compared with covariances.
enum class Gauge { weighted, protocol, none, origin, posyaw, se3, sim3 };
inline auto choices(Gauge) {
  return std::array{std::pair{"weighted", Gauge::weighted},
                    std::pair{"protocol", Gauge::protocol},
                    std::pair{"none", Gauge::none},
                    std::pair{"origin", Gauge::origin},
                    std::pair{"posyaw", Gauge::posyaw},
                    std::pair{"se3", Gauge::se3},
                    std::pair{"sim3", Gauge::sim3}};
}

struct NeesOptions {
  Gauge gauge = Gauge::weighted;
};

template <class Visit>
void fields(NeesOptions& o, Visit visit) {
  visit("gauge",
        o.gauge,
        "alignment of the errors; weighted: as the protocol, but weighted by the covariances, as "
        "are posyaw, se3 and sim3; protocol: as for other errors; none: covariances in the frame "
        "of the reference; origin: relative to the first pose");
}

/// Normalised estimation error squared e^T C^-1 e: e is the position error [m] and the logarithm of
/// the rotation error [rad] in fixed axes (datasets/core/covariance.hpp), C the covariance of the
/// estimate, rotated and scaled by the alignment, plus that of the reference, both interpolated
/// linearly where poses are. Parts: `pose` (6 degrees of freedom), `position` and `rotation` (3).
///
/// `nees` of each part [-], which is chi-squared distributed if the covariances are right.
/// `nees_ratio`: sum of all NEES over their degrees of freedom without those that the alignment
/// removes (target 1), with the 95 % interval `nees_ratio_low` to `nees_ratio_high`. `coverage_50`,
/// `_90`, `_95` [%]: share of errors inside the ellipsoid, or the interval of one axis (`rx`:
/// rotation about x), of this probability; the target is the probability. `coverage_95_low` and
/// `_high` are its 95 % interval, and the axes `third 1` to `third 3` follow `pose` (`position`
/// without rotations) along the path. `independent`: number of pairs over the integrated
/// autocorrelation of the NEES, from which intervals are computed.
///
/// Gauges `weighted`, posyaw, se3 and sim3 minimise the sum of the NEES (of the pose, or without
/// rotations of the position) over the alignment, from the protocol's least squares of positions.
/// The latter (`protocol`) leave a common rotation error, which is large beside small deviations of
/// the rotation. With gauge `origin`, the first pair is the origin, has no error and is not
/// counted: covariances must be relative to the first pose.
///
/// Planar covariances (none of z, roll and pitch) have 3 degrees of freedom of the pose and 2 of
/// the position, and gauges `origin`, `none` and `protocol`. Without rotations, only the position
/// is scored. Throws Undefined without covariances of the estimate and for projected trajectories;
/// std::runtime_error if C is not positive definite. O(n log n).
///
/// Source: Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with applications to tracking and
/// navigation, 2001, section 5.4.
std::vector<Score> nees(const Evaluation& evaluation, const NeesOptions& options = {});

}  // namespace loopbench::metrics
