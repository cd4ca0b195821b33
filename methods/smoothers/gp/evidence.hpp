/// Hyper-parameters of the Gaussian process by marginal likelihood.
#pragma once

#include <optional>

#include "methods/smoothers/gp/posterior.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"

namespace loopbench {

/// Empty where the data shall decide; powers are per mean interval.
struct GpGiven {
  std::optional<double> sigma_t, sigma_r, power_t, power_r;
};

/// Steps down -log evidence on a lattice of exponents (10^(k / 8)), one parameter at a time, half a
/// decade first, then finer. `states` are where the problem is linearised. Some 50 eliminations of
/// O(n).
struct GpChosen {
  GpParameters parameters;
  int evaluations = 0;
};

/// From the scalar form of the same model for P = 2, which is the smoothing spline (reinsch.hpp)
/// with restricted likelihood; GCV gives another start. Valleys of the evidence are several where
/// keyframes are sparse, so both are worth trying.
GpParameters first_parameters(const Trajectory& measured,
                              int P,
                              Criterion criterion,
                              const GpGiven& given);

template <int P>
GpChosen chosen_parameters(const GpPosterior<P>& posterior,
                           const typename GpPosterior<P>::States& states,
                           const GpParameters& start,
                           const GpGiven& given);

}  // namespace loopbench
