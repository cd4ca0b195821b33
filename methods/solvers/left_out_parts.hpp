/// What a solved pose graph predicts for its closures without some of them.
#pragma once

#include <Eigen/Cholesky>
#include <cstddef>
#include <optional>
#include <vector>

#include "methods/solvers/graph_inverse.hpp"
#include "methods/solvers/left_out_closures.hpp"

namespace loopbench::methods {

/// Pairs of poses whose covariances LeftOutParts needs: those between the ends of the closures of
/// each part. O(sum of squares of the parts' sizes).
inline std::vector<std::pair<std::size_t, std::size_t>> pairs_within(
    const std::vector<Edge>& closures, const std::vector<std::vector<std::size_t>>& parts) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (const std::vector<std::size_t>& part : parts) {
    std::vector<std::size_t> ends;
    for (const std::size_t k : part) {
      ends.push_back(closures[k].from);
      ends.push_back(closures[k].to);
    }
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) out.emplace_back(ends[j], ends[i]);
    }
  }
  return out;
}

/// Closures left out of the solution of a pose graph, to first order at its poses. With white
/// residuals w = U e of a set of closures (U' U = Omega), their Jacobian J and the covariance P of
/// the poses, the residuals of the set keep the share R = I - U J P J' U' of their variance, and
/// without the set they are R^-1 w, with covariance R^-1.
template <class G>
class LeftOutParts {
 public:
  using Square = typename G::Square;
  using Tangent = typename G::Tangent;
  static constexpr Eigen::Index D = G::kDof;

  /// `poses` and `problem` are those of `inverse`, which must outlive this object.
  LeftOutParts(const std::vector<ScaledPose>& poses,
               const Problem& problem,
               const GraphInverse<G>& inverse)
      : inverse_(&inverse), closures_(&problem.closures) {
    const ScaledPose first_from_world = poses.front().inverse();
    for (const Edge& edge : problem.closures) {
      const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(edge))),
                                                  G::from(first_from_world * poses[edge.from]),
                                                  G::from(first_from_world * poses[edge.to]));
      const Square root = information_root<G>(edge, 1.0, 1.0);
      root_.push_back(root);
      white_.push_back(root * at.error);
      by_from_.push_back(root * at.by_from);
      by_to_.push_back(root * at.by_to);
    }
  }

  /// Each closure of the set without all of them, in the order of `closures`; empty: the rest does
  /// not determine them, to rounding. The pairs of their ends must be pairs of the inverse. O(size
  /// of the set^3).
  std::vector<LeftOut<G>> without(const std::vector<std::size_t>& closures) const {
    constexpr double kDetermined = 1e-10;  // least share of a variance that is not rounding
    const auto count = static_cast<Eigen::Index>(closures.size());
    Eigen::MatrixXd share = Eigen::MatrixXd::Identity(D * count, D * count);
    Eigen::VectorXd white(D * count);
    for (Eigen::Index a = 0; a < count; ++a) {
      const std::size_t k = closures[static_cast<std::size_t>(a)];
      white.segment<D>(D * a) = white_[k];
      for (Eigen::Index b = 0; b <= a; ++b) {
        share.block<D, D>(D * a, D * b) -= predicted(k, closures[static_cast<std::size_t>(b)]);
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(share);
    const bool is_determined =
        factor.info() == Eigen::Success &&
        factor.matrixLLT().diagonal().array().square().minCoeff() > kDetermined;
    if (!is_determined) return {};
    const Eigen::MatrixXd wider = factor.solve(Eigen::MatrixXd::Identity(D * count, D * count));
    const Eigen::VectorXd error = wider * white;
    std::vector<LeftOut<G>> out;
    for (Eigen::Index a = 0; a < count; ++a) {
      const std::size_t k = closures[static_cast<std::size_t>(a)];
      const Square back =
          root_[k].template triangularView<Eigen::Upper>().solve(Square(Square::Identity()));
      const Square own = wider.block<D, D>(D * a, D * a);
      out.push_back({back * error.segment<D>(D * a),
                     back * own * back.transpose(),
                     white_[k].squaredNorm(),
                     share.block<D, D>(D * a, D * a).trace()});
    }
    return out;
  }

  /// Decrease of the sum of squared errors without this closure alone, whose LeftOut is given [-].
  double cost_drop(std::size_t closure, const LeftOut<G>& alone) const {
    return (root_[closure] * alone.error).dot(white_[closure]);
  }

  /// Gradient of half the sum of squared errors that vanishes without this closure, D rows per
  /// pose, for GraphInverse::solve(): the change of the poses.
  Eigen::MatrixXd force(std::size_t closure, const LeftOut<G>& alone, std::size_t poses) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(D * static_cast<Eigen::Index>(poses), 1);
    const Tangent white = root_[closure] * alone.error;
    const Edge& edge = (*closures_)[closure];
    const auto row = [](std::size_t pose) { return D * static_cast<Eigen::Index>(pose); };
    out.col(0).template segment<D>(row(edge.from)) += by_from_[closure].transpose() * white;
    out.col(0).template segment<D>(row(edge.to)) += by_to_[closure].transpose() * white;
    return out;
  }

 private:
  /// Covariance of the white residuals of two closures by that of the poses.
  Square predicted(std::size_t a, std::size_t b) const {
    const Edge& one = (*closures_)[a];
    const Edge& other = (*closures_)[b];
    const auto part = [&](const Square& left, std::size_t i, const Square& right, std::size_t j) {
      return Square(left * inverse_->covariance(i, j) * right.transpose());
    };
    return part(by_from_[a], one.from, by_from_[b], other.from) +
           part(by_from_[a], one.from, by_to_[b], other.to) +
           part(by_to_[a], one.to, by_from_[b], other.from) +
           part(by_to_[a], one.to, by_to_[b], other.to);
  }

  const GraphInverse<G>* inverse_;
  const std::vector<Edge>* closures_;
  std::vector<Square> root_;  ///< U
  std::vector<Tangent> white_;
  std::vector<Square> by_from_, by_to_;  ///< U J
};

}  // namespace loopbench::methods
