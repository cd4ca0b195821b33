/// Conditional densities of loops, given some of them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "methods/correctors/consensus/cycle_model.hpp"

namespace loopbench::methods::consensus {

/// Squared Mahalanobis distance of an error, and logarithm of its density.
struct ErrorDensity {
  double squared = std::numeric_limits<double>::infinity();
  double log_density = -std::numeric_limits<double>::infinity();
};

template <class Error, class Covariance>
ErrorDensity normal_density(const Error& error, const Covariance& covariance) {
  const Eigen::LLT<Covariance> factor(covariance);
  if (factor.info() != Eigen::Success) return {};
  const Error white = factor.matrixL().solve(error);
  const double squared = white.squaredNorm();
  const double log_root = factor.matrixLLT().diagonal().array().log().sum();
  constexpr double kLog2Pi = 1.8378770664093453;
  const auto size = static_cast<double>(error.size());
  return {squared, -0.5 * (squared + size * kLog2Pi) - log_root};
}

/// Cholesky factorisation of the covariance of the loops of a model, one loop at a time in any
/// order: after each, the error and the covariance of every other loop given those so far. The
/// covariance of two loops is computed when it is needed, so that memory is linear in loops for a
/// bounded number of steps. O(loops steps) per step.
template <class G>
class Elimination {
 public:
  static constexpr Eigen::Index D = G::kDof;
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;

  Elimination(const CycleModel<G>& model, const LogFactors& factors)
      : model_(&model),
        sums_(model.step_sums(factors)),
        closure_variance_(std::exp(2.0 * factors.closures)) {
    for (std::size_t a = 0; a < model.size(); ++a) {
      error_.push_back(model.rho(a));
      covariance_.push_back(model.shared(sums_, a, a) + closure_variance_ * model.own(a));
    }
  }

  /// Error and covariance of a loop given those of loops().
  const Tangent& error(std::size_t loop) const { return error_[loop]; }
  const Square& covariance(std::size_t loop) const { return covariance_[loop]; }
  ErrorDensity density(std::size_t loop) const {
    return normal_density(error_[loop], covariance_[loop]);
  }

  const std::vector<std::size_t>& loops() const { return loops_; }

  /// Sum of the log densities of loops(), each given those before, relative to the uniform one.
  double log_odds() const { return log_odds_; }

  /// Returns false, without effect, if the covariance of the loop is not positive definite.
  bool condition_on(std::size_t loop) {
    const Eigen::LLT<Square> factor(covariance_[loop]);
    if (factor.info() != Eigen::Success) return false;
    log_odds_ += density(loop).log_density - model_->log_uniform();
    const auto rows = D * static_cast<Eigen::Index>(model_->size());
    const auto done = D * static_cast<Eigen::Index>(loops_.size());
    if (factor_.cols() < done + D) factor_.conservativeResize(rows, 2 * done + 8 * D);
    auto column = factor_.middleCols(done, D);
    for (std::size_t a = 0; a < model_->size(); ++a) {
      column.middleRows(row(a), D) = model_->shared(sums_, a, loop);
    }
    column.middleRows(row(loop), D) += closure_variance_ * model_->own(loop);
    column.noalias() -= factor_.leftCols(done) * factor_.block(row(loop), 0, D, done).transpose();
    factor.matrixU().template solveInPlace<Eigen::OnTheRight>(column);
    const Tangent white = factor.matrixL().solve(error_[loop]);
    loops_.push_back(loop);
    for (std::size_t a = 0; a < model_->size(); ++a) {
      const Square part = column.middleRows(row(a), D);
      error_[a] -= part * white;
      covariance_[a] -= part * part.transpose();
    }
    return true;
  }

  /// Conditions on the loops in this order; false: their covariance is not positive definite.
  bool condition_on(const std::vector<std::size_t>& loops) {
    for (const std::size_t each : loops) {
      if (!condition_on(each)) return false;
    }
    return true;
  }

  double closure_variance() const { return closure_variance_; }

 private:
  static Eigen::Index row(std::size_t loop) { return D * static_cast<Eigen::Index>(loop); }

  const CycleModel<G>* model_;
  std::vector<Square> sums_;
  double closure_variance_;
  std::vector<Tangent> error_;
  std::vector<Square> covariance_;
  std::vector<std::size_t> loops_;
  Eigen::MatrixXd factor_;  ///< rows of all loops, columns of loops()
  double log_odds_ = 0.0;
};

}  // namespace loopbench::methods::consensus
