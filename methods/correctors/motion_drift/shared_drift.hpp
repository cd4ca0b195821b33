/// Drift of an odometer, learnt from the loops of its other chains.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/core/problem.hpp"
#include "methods/correctors/loop_covariance.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Rates of the rotation error e in X_i = X_{i-1} Z_i Exp(e): about x, y and z per metre of the
/// edge's length [rad/m]; in the plane also about z per radian of rotation [-], as from a wrong
/// wheel base.
using DriftRates = Eigen::Vector4d;

/// Posterior of the rates of one more chain of the odometer.
struct SharedDrift {
  DriftRates mean = DriftRates::Zero();
  DriftRates variance = DriftRates::Zero();  ///< of the mean, and between chains
  DriftRates variance_of_mean = DriftRates::Zero();
  VarianceFactors factors;  ///< on the stated covariances of the odometry
};

/// The rates b_c of chain c are N(m, T), and m is N(0, M); gaps of its loops measure them with the
/// noise of the odometry and the closures. T, M (diagonal) and the factors maximise the likelihood
/// of all gaps, with a weak prior of T / M about 1; T is large, and the mean uncertain, where drift
/// does not repeat. A rate enters only if it raises the log likelihood by 4. Gaps are linearised
/// again at the mean. Chains need complete odometry and closures. No reference is used. Complexity:
/// some thousand factorisations of 4 x 4 matrices per chain, some hundred of size 6 closures.
/// Source: Laird and Ware, Random-effects models for longitudinal data, Biometrics 38(4), 1982.
SharedDrift shared_drift(const std::vector<Problem>& chains);

/// The chain with the rates removed from its odometry and keyframes. O(edges).
Problem without_drift(Problem problem, const DriftRates& rates);

/// The rates of `problem.related` that may be removed from `problem`; zero, with a note, if there
/// are fewer than three chains or 16 closures to learn from. Rates about axes out of the plane are
/// not removed from a planar problem, nor rates per radian from others. A rate has to be three
/// times its standard error and larger than the deviation between chains, and none is removed if
/// the chain's own loops are less likely without them.
DriftRates repeated_drift(const Problem& problem, Report& report);

}  // namespace loopbench::methods
