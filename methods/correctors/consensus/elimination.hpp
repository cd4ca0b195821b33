/// Conditional densities of loops, given some of them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/cycle_model.hpp"
#include "methods/solvers/panel_kernels.hpp"

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
      order_.push_back(a);
      position_.push_back(a);
    }
  }

  /// Error and covariance of a loop given those of loops(), which it is not one of.
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
    add_column(loop, factor);
    const Tangent white = factor.matrixL().solve(error_[loop]);
    loops_.push_back(loop);
    const auto column = factor_.middleCols(row(loop), D);
    for (std::size_t k = loops_.size(); k < order_.size(); ++k) {
      const std::size_t a = order_[k];
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
  Eigen::Index row(std::size_t loop) const {
    return D * static_cast<Eigen::Index>(position_[loop]);
  }

  /// The columns of the next loop, for the rows of those after it.
  void add_column(std::size_t loop, const Eigen::LLT<Square>& own) {
    const std::size_t at = loops_.size();
    const auto rows = D * static_cast<Eigen::Index>(model_->size());
    const auto begin = D * static_cast<Eigen::Index>(at);
    if (factor_.cols() < begin + D) {
      factor_.conservativeResize(rows, std::min(rows, 2 * begin + 8 * D));
    }
    move_to(at, loop);
    factor_.block(begin, begin, D, D).setZero();
    for (std::size_t k = at + 1; k < order_.size(); ++k) {
      factor_.block(row(order_[k]), begin, D, D) = model_->shared(sums_, order_[k], loop);
    }
    for (Eigen::Index c = begin; c < begin + D; ++c) {
      for (Eigen::Index k = 0; k < begin; k += D) {
        subtract<D>(factor_.col(c).data(), factor_.col(k).data(), rows, c, rows);
      }
    }
    auto below = factor_.block(begin + D, begin, rows - begin - D, D);
    own.matrixU().template solveInPlace<Eigen::OnTheRight>(below);
  }

  /// Exchanges the rows of a loop with those at a position.
  void move_to(std::size_t position, std::size_t loop) {
    const std::size_t other = order_[position];
    if (other == loop) return;
    const auto done = D * static_cast<Eigen::Index>(loops_.size());
    factor_.block(row(loop), 0, D, done).swap(factor_.block(row(other), 0, D, done));
    std::swap(order_[position_[loop]], order_[position]);
    std::swap(position_[loop], position_[other]);
  }

  const CycleModel<G>* model_;
  std::vector<Square> sums_;
  double closure_variance_;
  std::vector<Tangent> error_;
  std::vector<Square> covariance_;
  std::vector<std::size_t> loops_;
  std::vector<std::size_t> order_;     ///< of rows: loops(), then the others
  std::vector<std::size_t> position_;  ///< of each loop in it
  Eigen::MatrixXd factor_;             ///< rows of all loops, columns of loops()
  double log_odds_ = 0.0;
};

}  // namespace loopbench::methods::consensus
