/// Estimate of the factors on stated deviations from loops that are taken as true.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
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

/// Covariance of some loops of a model as a function of the factors. Keeps the memory of a
/// factorisation, so that one thread at a time can use it.
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
      to.resize(size, size);  // the upper triangle is not used
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
    set_covariance(at);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> factor(covariance_);
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const Eigen::VectorXd white = factor.matrixL().solve(rho_);
    constexpr double kLog2Pi = 1.8378770664093453;
    return -0.5 * (white.squaredNorm() + static_cast<double>(rho_.size()) * kLog2Pi) -
           covariance_.diagonal().array().log().sum() - log_uniform_;
  }

  double log_posterior(const LogFactors& at) const {
    const double prior = log_prior(at);
    return std::isinf(prior) ? prior : log_odds(at) + prior;
  }

 private:
  /// The lower triangle of the covariance.
  void set_covariance(const LogFactors& at) const {
    const double t = std::exp(at.translation), r = std::exp(at.rotation);
    const Eigen::Index size = rho_.size(), D = own_.cols();
    covariance_.resize(size, size);
    for (Eigen::Index j = 0; j < size; ++j) {
      const Eigen::Index rows = size - j;
      auto column = covariance_.col(j).tail(rows);
      column = t * t * translation_.col(j).tail(rows) + r * r * rotation_.col(j).tail(rows);
      if (mixed_.size() > 0) column += t * r * mixed_.col(j).tail(rows);
      if (unknown_.size() > 0) column += unknown_.col(j).tail(rows);
    }
    const double variance = std::exp(2.0 * at.closures);
    for (Eigen::Index i = 0; i < size; i += D) {
      covariance_.block(i, i, D, D) += variance * own_.middleRows(i, D);
    }
  }

  double log_uniform_;
  Eigen::VectorXd rho_;
  Eigen::MatrixXd own_;  ///< blocks on the diagonal, one below the other
  Eigen::MatrixXd translation_, rotation_, mixed_, unknown_;  ///< lower triangles; empty: zero
  mutable Eigen::MatrixXd covariance_;                        ///< then its factor
};

/// Climbs the posterior from `at`: steps of `step` along both factors of the odometry together,
/// against each other, and along that of the closures, halved when none improves, down to `least`.
/// On a lattice, so that rounding does not change the result. No point is evaluated twice: what did
/// not improve will not.
inline LogFactors climb(const LoopLikelihood& loops, LogFactors at, double step, double least) {
  constexpr double kImproves = 1e-6;
  constexpr std::array<std::array<int, 3>, 3> kDirections{{{1, 1, 0}, {1, -1, 0}, {0, 0, 1}}};
  using Point = std::array<int, 3>;  // in steps from the first
  Point here{};
  std::vector<Point> seen{here};
  double best = loops.log_posterior(at);
  std::array<int, 3> sign{1, 1, 1};
  const auto halve = [](Point& point) {
    for (int& each : point) each *= 2;
  };
  for (; step > least; step *= 0.5) {
    for (bool improved = true; improved;) {
      improved = false;
      for (std::size_t d = 0; d < kDirections.size(); ++d) {
        for (int attempt = 0; attempt < 2; ++attempt) {
          const double by = sign[d] * step;
          const LogFactors trial{at.translation + by * kDirections[d][0],
                                 at.rotation + by * kDirections[d][1],
                                 at.closures + by * kDirections[d][2]};
          Point there = here;
          for (std::size_t i = 0; i < there.size(); ++i) there[i] += sign[d] * kDirections[d][i];
          const bool is_new = std::ranges::find(seen, there) == seen.end();
          if (is_new) seen.push_back(there);
          const double value = is_new ? loops.log_posterior(trial) : best;
          if (value > best + kImproves) {
            best = value;
            at = trial;
            here = there;
            improved = true;
            break;
          }
          sign[d] = -sign[d];
        }
      }
    }
    halve(here);
    std::ranges::for_each(seen, halve);
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
