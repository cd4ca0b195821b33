/// Estimates the hyperparameters of the Gaussian process by maximum marginal likelihood.
#pragma once

#include <optional>

#include "methods/smoothers/gp/posterior.hpp"
#include "methods/smoothers/penalised/reinsch.hpp"

namespace loopbench::methods {

/// Hyperparameters fixed by the user; empty values are estimated. Powers are per mean interval.
struct GpFixedParameters {
  std::optional<double> sigma_t, sigma_r, power_t, power_r;
};

/// Result of estimate_parameters(): coordinate descent of -log evidence on a lattice of exponents
/// (10^(k / 8)), with steps of half a decade at first and then halved steps. `states` is the
/// linearisation point. About 50 eliminations of O(n).
struct GpEstimate {
  GpParameters parameters;
  int evaluations = 0;
};

/// Returns initial hyperparameters from the scalar form of the model for P = 2, the smoothing
/// spline (reinsch.hpp), with the restricted likelihood or GCV. For sparse keyframes the evidence
/// has several local maxima, so both criteria should be tried.
GpParameters initial_parameters(const Trajectory& measured,
                                int P,
                                Criterion criterion,
                                const GpFixedParameters& given);

template <int P>
GpEstimate estimate_parameters(const GpPosterior<P>& posterior,
                               const typename GpPosterior<P>::States& states,
                               const GpParameters& start,
                               const GpFixedParameters& given);

}  // namespace loopbench::methods
