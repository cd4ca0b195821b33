/// Maximum likelihood estimation of noise variances from edges with known errors.
#pragma once

#include <vector>

#include "harness/calibrate/residuals.hpp"
#include "methods/correctors/motion_drift/model.hpp"

namespace loopbench::harness {

/// Regressors of the translation or rotation error, with their variances.
struct Rates {
  methods::Component component = methods::Component::translation;
  std::vector<methods::Regressor> noise;
  std::vector<methods::Regressor> drift;
  std::vector<double> noise_variance;  ///< [m^2/unit] or [rad^2/unit]
  std::vector<double> drift_variance;  ///< of a rate on one axis [(m/unit)^2] or [(rad/unit)^2]
};

/// Log density of the errors: on every axis e = sum_j phi_j b_j + w, w_i ~ N(0, sum_j a_j phi_ij),
/// b_j ~ N(0, v_j) drawn once per sequence. O(edges terms^2).
double log_likelihood(const Rates& rates, const std::vector<CalibrationResiduals>& sequences);

/// Number of errors: edges times axes of the component.
double count(methods::Component component, const std::vector<CalibrationResiduals>& sequences);

/// Increases log_likelihood in each of `iterations` iterations with non-negative coefficients: with
/// C the covariance of an axis, Q_j the contribution of a term and alpha = C^-1 e,
///
///     a_j <- a_j sqrt(sum alpha' Q_j alpha / sum tr(C^-1 Q_j)).
///
/// Without drift these are the Itakura-Saito updates of nonnegative matrix factorisation. C is
/// inverted through the drift terms (Woodbury). O(iterations edges terms^2). Sources: Zhou et al.,
/// MM algorithms for variance components models, 2019; Fevotte, Bertin, Durrieu, 2009.
Rates fit_rates(methods::Component component,
                const std::vector<methods::Regressor>& noise,
                const std::vector<methods::Regressor>& drift,
                const std::vector<CalibrationResiduals>& sequences,
                int iterations = 500);

}  // namespace loopbench::harness
