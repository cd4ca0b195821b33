/// Variance components of a chain's odometry, estimated from its loop gaps.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>

#include "datasets/core/problem.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/report.hpp"

namespace loopbench::methods {

/// Factors on the stated variances of all odometry edges [-].
struct VarianceFactors {
  double translation = 1.0;
  double rotation = 1.0;
};

inline constexpr double kLattice = 0.25;             // spacing of the factors [octaves]
inline constexpr int kLastIndex = 53;                // largest lattice index: a factor of 1e4
inline constexpr double kPriorOctaves = 6.64385619;  // prior deviation: a factor of 10 in deviation

using LatticePoint = std::array<int, 2>;  // lattice indices of translation and rotation

inline double factor_of(int steps) { return std::exp2(kLattice * steps); }

/// Rows of the gap vector that are measured: six per closure, or x, y and yaw if planar.
inline std::vector<Eigen::Index> gap_rows(std::size_t closures, bool planar) {
  const std::vector<int> axes = planar ? std::vector{0, 1, 5} : std::vector{0, 1, 2, 3, 4, 5};
  std::vector<Eigen::Index> out;
  for (std::size_t k = 0; k < closures; ++k) {
    for (const int axis : axes) out.push_back(static_cast<Eigen::Index>(6 * k) + axis);
  }
  return out;
}

/// Gaps of all closures at the current poses of a chain, and what their covariance consists of.
struct LoopCovariance {
  Eigen::VectorXd gap;
  Eigen::MatrixXd translation, rotation, mixed, closures;

  /// Covariance under the factors. Only the lower triangle is valid.
  Eigen::MatrixXd under(const VarianceFactors& factors) const {
    return factors.translation * translation + factors.rotation * rotation +
           std::sqrt(factors.translation * factors.rotation) * mixed + closures;
  }
};

/// O(edges + closures^2).
inline LoopCovariance loop_covariance(const Problem& problem,
                                      const NoiseModel& stated,
                                      const LoopedChain& chain) {
  const LoopJacobian jacobian = chain.linearise();
  const std::vector<Eigen::Index> rows = gap_rows(problem.closures.size(), problem.planar);
  const auto through = [&](auto part) -> Eigen::MatrixXd {
    const Eigen::MatrixXd all = propagate_covariance(
        jacobian, chain.sums(), running_sum(chain.sums(), [&](std::size_t i) -> Matrix6 {
          return jacobian.edge[i] * part(stated.covariance[i]) * jacobian.edge[i].transpose();
        }));
    return all(rows, rows);
  };
  const auto block = [](const Matrix6& S, Eigen::Index row, Eigen::Index column) {
    Matrix6 out = Matrix6::Zero();
    out.block<3, 3>(row, column) = S.block<3, 3>(row, column);
    return out;
  };
  LoopCovariance out;
  out.gap = jacobian.gap(rows);
  out.translation = through([&](const Matrix6& S) { return block(S, 0, 0); });
  out.rotation = through([&](const Matrix6& S) { return block(S, 3, 3); });
  out.mixed = through([&](const Matrix6& S) -> Matrix6 { return block(S, 0, 3) + block(S, 3, 0); });
  const auto size = static_cast<Eigen::Index>(6 * problem.closures.size());
  Eigen::MatrixXd closures = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < problem.closures.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(6 * k);
    closures.block<6, 6>(at, at) = stated.closure_covariance[k];
  }
  out.closures = closures(rows, rows);
  return out;
}

/// Returns -log posterior up to a constant, or infinity when the covariance is not positive
/// definite.
inline double objective(const LoopCovariance& loops, const LatticePoint& steps) {
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(
      loops.under({factor_of(steps[0]), factor_of(steps[1])}));
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  const Eigen::VectorXd white = factor.matrixL().solve(loops.gap);
  double out = 0.5 * white.squaredNorm() + factor.matrixLLT().diagonal().array().log().sum();
  for (const int each : steps) {
    const double octaves = kLattice * each / kPriorOctaves;  // factors are of variances
    out += 0.5 * octaves * octaves;
  }
  return out;
}

/// Coordinate descent over both factors, with steps of 4 octaves at first and then halved steps.
inline LatticePoint minimise_factors(const LoopCovariance& loops, LatticePoint at) {
  double least = objective(loops, at);
  for (int step = 16; step >= 1; step /= 2) {
    for (bool improved = true; improved;) {
      improved = false;
      for (const std::size_t which : {0u, 1u}) {
        for (const int by : {step, -step}) {
          LatticePoint trial = at;
          trial[which] += by;
          if (std::abs(trial[which]) > kLastIndex) continue;
          const double value = objective(loops, trial);
          if (!(value < least)) continue;
          least = value;
          at = trial;
          improved = true;
          break;
        }
      }
    }
  }
  return at;
}

/// Returns the problem with D S D in place of S. O(edges).
inline Problem with_factors(Problem problem, const VarianceFactors& factors) {
  Twist shrink;
  shrink.head<3>().setConstant(1.0 / std::sqrt(factors.translation));
  shrink.tail<3>().setConstant(1.0 / std::sqrt(factors.rotation));
  for (Edge& edge : problem.odometry) {
    edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  }
  return problem;
}

/// Maximises the likelihood of the closure errors before correction over both factors,
///
///     c ~ N(0, A D S D A' + S_L),   D = diag(sqrt(translation) I, sqrt(rotation) I),
///
/// where S and S_L are the stated covariances of odometry and closures, times a weak prior: the
/// stated standard deviations are correct up to a factor of 10 (log-normal, one deviation).
/// Relinearises at the solution until the factors no longer change. The factors lie on a lattice
/// with a spacing of 1/4 octave in 1e-4 .. 1e4. Requires complete odometry (why_no_chain()) and at
/// least one closure. Complexity: about 50 Cholesky factorisations of size 6 closures in each of at
/// most 5 rounds. Source: Koch, Parameter Estimation and Hypothesis Testing in Linear Models, 1999,
/// section 3.6 (maximum likelihood variance components). No reference is used.
inline VarianceFactors variance_factors(const Problem& problem) {
  constexpr int kRounds = 5;
  constexpr int kSteps = 30;
  constexpr double kConverged = 1e-6;  // relative change of the cost
  const NoiseModel stated = stated_noise_model(problem);
  LoopedChain chain(problem, stated);
  LatticePoint at{0, 0};
  for (int round = 0; round < kRounds; ++round) {
    const LatticePoint next = minimise_factors(loop_covariance(problem, stated, chain), at);
    if (round > 0 && next == at) break;
    at = next;
    chain.set_noise_model(
        stated_noise_model(with_factors(problem, {factor_of(at[0]), factor_of(at[1])})));
    chain.minimise(kSteps, kConverged);
  }
  return {factor_of(at[0]), factor_of(at[1])};
}

/// Returns the problem with the estimated factors. Adds the counts `factor_t` and `factor_r`,
/// factors on standard deviations.
inline Problem with_estimated_factors(const Problem& problem, Report& report) {
  const VarianceFactors factors =
      report.time("variance components", [&] { return variance_factors(problem); });
  report.count("factor_t", std::sqrt(factors.translation));
  report.count("factor_r", std::sqrt(factors.rotation));
  return with_factors(problem, factors);
}

}  // namespace loopbench::methods
