/// What exact knowledge of a chain's drift, or of its loops, would leave of the error.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/studies/development_chains.hpp"

namespace loopbench {

/// Quantities that the rates of an oracle are proportional to. `gains`: one factor on translations
/// and one on the measured rotation about each axis (a wrong wheel base in the plane).
enum class OracleModel { time, distance, rotation, gains, all };
inline constexpr std::array kOracleModels{OracleModel::time,
                                          OracleModel::distance,
                                          OracleModel::rotation,
                                          OracleModel::gains,
                                          OracleModel::all};

/// Uses the reference, so it is no method. Least ATE [m] that `dual` leaves if constant rates of
/// drift are removed first, over all rates of the model: per body axis of translation and rotation,
/// and of log scale for Sim(3) chains. Whatever estimates such rates is above it, apart from local
/// minima. Levenberg-Marquardt with differences, from zero rates; about 300 corrections.
double oracle_error(const DevelopmentChain& chain, OracleModel model);

/// ATE [m] that `dual` leaves with the gains that minimise its own cost, under a prior of 10 % on
/// each: an estimate from odometry and loops only, without the reference. NaN for Sim(3) chains.
double gains_from_loops_error(const DevelopmentChain& chain);

/// ATE (RMSE) of the keyframes after rigid alignment, with scale for Sim(3) chains [m].
double aligned_error(const Trajectory& estimate, const DevelopmentChain& chain);

/// A chain without drift: the truth is the result of `dual`, odometry and closures are drawn around
/// it with the covariances rescaled from the loops. Scale is exact in rigid chains only.
DevelopmentChain without_drift_control(const DevelopmentChain& chain, int seed);

}  // namespace loopbench
