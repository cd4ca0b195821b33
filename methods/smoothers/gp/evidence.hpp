/// Hyper-parameters of the Gaussian process by marginal likelihood.
#pragma once

#include <optional>

#include "methods/smoothers/gp/posterior.hpp"

namespace loopbench {

/// Empty where the data shall decide; powers are per mean interval.
struct GpGiven {
  std::optional<double> sigma_t, sigma_r, power_t, power_r;
};

/// Steps down -log evidence on a lattice of exponents (10^(k / 8)), one parameter at a time, half a
/// decade first, then finer. The start comes from the scalar form of the same model for P = 2,
/// which is the smoothing spline with restricted likelihood (reinsch.hpp). `states` are where the
/// problem is linearised. Some 50 eliminations: O(n).
struct GpChosen {
  GpParameters parameters;
  int evaluations = 0;
};
GpParameters first_parameters(const Trajectory& measured, int P, const GpGiven& given);
template <int P>
GpChosen chosen_parameters(const GpPosterior<P>& posterior,
                           const typename GpPosterior<P>::States& states,
                           const GpParameters& start,
                           const GpGiven& given);

}  // namespace loopbench
