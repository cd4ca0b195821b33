/// Solution of the linear model of a chain for loops that are taken as true.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "methods/correctors/consensus/cycle_model.hpp"
#include "methods/solvers/left_out_closures.hpp"

namespace loopbench::methods::consensus {

/// Joint covariance C of some loops of a model under given factors, factorised.
/// O((loops kDof)^3).
template <class G>
class JointLoops {
 public:
  static constexpr Eigen::Index D = G::kDof;
  using Tangent = typename G::Tangent;
  using Square = typename G::Square;

  JointLoops(const CycleModel<G>& model,
             const LogFactors& factors,
             const std::vector<std::size_t>& loops)
      : model_(model), loops_(loops), sums_(model.step_sums(factors)) {
    const auto size = D * static_cast<Eigen::Index>(loops.size());
    const double variance = std::exp(2.0 * factors.closures);
    covariance_.resize(size, size);
    rho_.resize(size);
    for (std::size_t j = 0; j < loops.size(); ++j) {
      for (std::size_t i = j; i < loops.size(); ++i) {
        covariance_.block<D, D>(row(i), row(j)) = model.shared(sums_, loops[i], loops[j]);
      }
      covariance_.block<D, D>(row(j), row(j)) += variance * model.own(loops[j]);
      rho_.template segment<D>(row(j)) = model.rho(loops[j]);
    }
    factor_.emplace(covariance_);
    if (is_positive()) multipliers_ = factor_->solve(rho_);
  }

  JointLoops(const JointLoops&) = delete;
  JointLoops& operator=(const JointLoops&) = delete;

  /// Whether C is positive definite; nothing else may be called otherwise.
  bool is_positive() const { return factor_->info() == Eigen::Success; }

  /// Errors of all loops, one below the other.
  const Eigen::VectorXd& rho() const { return rho_; }

  /// C^-1 times a matrix.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& of) const { return factor_->solve(of); }

  /// Poses of the chain corrected by the loops.
  std::vector<typename G::Element> corrected() const {
    std::vector<Tangent> multipliers;
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      multipliers.push_back(multipliers_.template segment<D>(row(i)));
    }
    return model_.corrected(sums_, loops_, multipliers);
  }

  /// One per loop: with P = C^-1, the covariance P_aa^-1 and the error P_aa^-1 (P rho)_a.
  std::vector<LeftOut<G>> left_out() const {
    constexpr std::size_t kPanel = 96 / D;  // loops
    std::vector<LeftOut<G>> out;
    Eigen::MatrixXd memory(covariance_.rows(), std::min(row(kPanel), covariance_.rows()));
    for (std::size_t begin = 0; begin < loops_.size(); begin += kPanel) {
      // L^-1 of C = L L': of these columns, the rows from the diagonal on
      const Eigen::Index rows = covariance_.rows() - row(begin);
      auto panel = memory.topLeftCorner(rows, std::min(memory.cols(), rows));
      panel.setZero();
      panel.diagonal().setOnes();
      covariance_.bottomRightCorner(rows, rows)
          .template triangularView<Eigen::Lower>()
          .solveInPlace(panel);
      for (std::size_t i = 0; i < kPanel && begin + i < loops_.size(); ++i) {
        const auto columns = panel.block(row(i), row(i), rows - row(i), D);
        const Square precision = columns.transpose() * columns;
        const Square covariance = inverse_of(precision);
        out.push_back(
            {covariance * multipliers_.template segment<D>(row(begin + i)), covariance, 0.0, 0.0});
      }
    }
    return out;
  }

 private:
  static Eigen::Index row(std::size_t loop) { return D * static_cast<Eigen::Index>(loop); }

  const CycleModel<G>& model_;
  const std::vector<std::size_t>& loops_;
  std::vector<Square> sums_;
  Eigen::MatrixXd covariance_;  ///< its lower triangle: the factor
  std::optional<Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower>> factor_;
  Eigen::VectorXd rho_, multipliers_;
};

}  // namespace loopbench::methods::consensus
