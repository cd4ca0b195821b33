/// Discernible trajectory and rotation errors: insensitive to a few outliers, sensitive to the
/// rest.
#pragma once

#include "metrics/metric.hpp"

namespace loopbench::metrics {

struct DiscernibleOptions {
  double cut = 5.0;
};

template <class Visit>
void fields(DiscernibleOptions& o, Visit visit) {
  visit("cut",
        o.cut,
        "largest counted error, over the median distance of the reference to its geometric median "
        "[-]",
        GreaterThan{0.0});
}

/// `dte` [-] and `dre` [deg]. Both trajectories are shifted to their geometric medians; the
/// estimate is rotated by the geodesic median of R_reference R_estimate^T and scaled to the
/// reference's median distance from the geometric median. Distances are cut at `cut` times this
/// median and divided by it; DTE is the average of their mean and rmse. DRE is that of the rotation
/// errors, not cut. Both ignore the protocol's alignment. Throws Undefined without rotations, or if
/// half of the positions coincide. O(n).
///
/// Source: S. Lee, J. Civera, What's wrong with the absolute trajectory error?, arXiv 2212.05376.
std::vector<Score> discernible(const Evaluation& evaluation, const DiscernibleOptions& options);

}  // namespace loopbench::metrics
