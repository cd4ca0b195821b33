/// Estimate of the factors on stated deviations from loops that are taken as true.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "methods/correctors/consensus/cycle_model.hpp"

namespace loopbench::methods::consensus {

/// A factor of 1e5: beyond it, deviations are those of other quantities.
inline constexpr double kLargestLogFactor = 11.5;

/// Log density of the factors, up to a constant: Student's t with 3 degrees of freedom on each
/// logarithm, scale ln 3. Stated deviations are mostly right within a factor of 3; the heavy tails
/// let ten loops overrule a factor of 100.
inline double log_prior(const LogFactors& at) {
  constexpr double kDof = 3.0;
  constexpr double kScale = 1.0986122886681098;
  double out = 0.0;
  for (const double each : {at.translation, at.rotation, at.closures}) {
    if (std::abs(each) > kLargestLogFactor) return -std::numeric_limits<double>::infinity();
    out -= 0.5 * (kDof + 1.0) * std::log1p(each * each / (kDof * kScale * kScale));
  }
  return out;
}

/// Covariance of some loops of a model as a function of the factors.
class LoopLikelihood {
 public:
  template <class G>
  LoopLikelihood(const CycleModel<G>& model, const std::vector<std::size_t>& loops)
      : log_uniform_(model.log_uniform() * static_cast<double>(loops.size())) {
    constexpr Eigen::Index D = G::kDof;
    const auto size = D * static_cast<Eigen::Index>(loops.size());
    rho_.resize(size);
    own_.setZero(size, D);
    const auto assemble = [&](const std::vector<typename G::Square>& sums, Eigen::MatrixXd& to) {
      if (sums.empty()) return;
      to.setZero(size, size);
      for (Eigen::Index j = 0; j < size; j += D) {
        for (Eigen::Index i = j; i < size; i += D) {
          to.block<D, D>(i, j) = model.shared(
              sums, loops[static_cast<std::size_t>(i / D)], loops[static_cast<std::size_t>(j / D)]);
        }
      }
    };
    assemble(model.translation_sums(), translation_);
    assemble(model.rotation_sums(), rotation_);
    assemble(model.mixed_sums(), mixed_);
    assemble(model.unknown_sums(), unknown_);
    for (Eigen::Index i = 0; i < size; i += D) {
      rho_.segment<D>(i) = model.rho(loops[static_cast<std::size_t>(i / D)]);
      own_.middleRows<D>(i) = model.own(loops[static_cast<std::size_t>(i / D)]);
    }
  }

  /// Log density of all errors relative to the uniform one; -infinity if the covariance is not
  /// positive definite. One Cholesky factorisation.
  double log_odds(const LogFactors& at) const {
    const double t = std::exp(at.translation), r = std::exp(at.rotation);
    Eigen::MatrixXd covariance = t * t * translation_ + r * r * rotation_;
    if (mixed_.size() > 0) covariance += t * r * mixed_;
    if (unknown_.size() > 0) covariance += unknown_;
    const double variance = std::exp(2.0 * at.closures);
    const Eigen::Index D = own_.cols();
    for (Eigen::Index i = 0; i < own_.rows(); i += D) {
      covariance.block(i, i, D, D) += variance * own_.middleRows(i, D);
    }
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factor(covariance);
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const Eigen::VectorXd white = factor.matrixL().solve(rho_);
    constexpr double kLog2Pi = 1.8378770664093453;
    return -0.5 * (white.squaredNorm() + static_cast<double>(rho_.size()) * kLog2Pi) -
           covariance.diagonal().array().log().sum() - log_uniform_;
  }

  double log_posterior(const LogFactors& at) const { return log_odds(at) + log_prior(at); }

 private:
  double log_uniform_;
  Eigen::VectorXd rho_;
  Eigen::MatrixXd own_;  ///< blocks on the diagonal, one below the other
  Eigen::MatrixXd translation_, rotation_, mixed_, unknown_;  ///< lower triangles; empty: zero
};

/// Climbs the posterior from `at`: steps of `step` along both factors of the odometry together,
/// against each other, and along that of the closures, halved when none improves, down to `least`.
/// On a lattice, so that rounding does not change the result.
inline LogFactors climb(const LoopLikelihood& loops, LogFactors at, double step, double least) {
  constexpr double kImproves = 1e-6;
  constexpr std::array<std::array<double, 3>, 3> kDirections{
      {{1.0, 1.0, 0.0}, {1.0, -1.0, 0.0}, {0.0, 0.0, 1.0}}};
  double best = loops.log_posterior(at);
  std::array<double, 3> sign{1.0, 1.0, 1.0};
  for (; step > least; step *= 0.5) {
    for (bool improved = true; improved;) {
      improved = false;
      for (std::size_t d = 0; d < kDirections.size(); ++d) {
        for (int attempt = 0; attempt < 2; ++attempt) {
          const double by = sign[d] * step;
          const LogFactors trial{at.translation + by * kDirections[d][0],
                                 at.rotation + by * kDirections[d][1],
                                 at.closures + by * kDirections[d][2]};
          const double value = loops.log_posterior(trial);
          if (value > best + kImproves) {
            best = value;
            at = trial;
            improved = true;
            break;
          }
          sign[d] = -sign[d];
        }
      }
    }
  }
  return at;
}

/// Spread of the log factor of the rotation at the maximum, by second differences of the posterior.
inline double rotation_spread(const LoopLikelihood& loops, const LogFactors& at) {
  constexpr double kStep = 0.15;
  Eigen::Matrix3d hessian;
  const auto value = [&](int i, int j, double by_i, double by_j) {
    Eigen::Vector3d moved(at.translation, at.rotation, at.closures);
    moved[i] += by_i * kStep;
    moved[j] += by_j * kStep;
    return loops.log_posterior({moved[0], moved[1], moved[2]});
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      hessian(i, j) = hessian(j, i) =
          -(value(i, j, 1, 1) - value(i, j, 1, -1) - value(i, j, -1, 1) + value(i, j, -1, -1)) /
          (4.0 * kStep * kStep);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(hessian);
  constexpr double kPriorPrecision = 0.5;
  const Eigen::Vector3d inverse = solver.eigenvalues().cwiseMax(kPriorPrecision).cwiseInverse();
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  return std::sqrt((axes * inverse.asDiagonal() * axes.transpose())(1, 1));
}

}  // namespace loopbench::methods::consensus
