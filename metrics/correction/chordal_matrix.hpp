/// Data matrix of the isotropic chordal cost of a pose graph, in blocks of keyframes.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "methods/solvers/block_cholesky.hpp"
#include "metrics/correction/chordal_weights.hpp"

namespace loopbench::metrics {

/// The cost is tr(X M X') for X = [t_0 R_0 t_1 R_1 ..], D x (D + 1) n, in the frame of keyframe 0.
template <int D>
class ChordalMatrix {
 public:
  static constexpr int kSize = D + 1;  ///< columns of a keyframe: translation, then rotation
  using Block = Eigen::Matrix<double, kSize, kSize>;
  using Rotation = Eigen::Matrix<double, D, D>;
  using Poses = Eigen::Matrix<double, D, Eigen::Dynamic>;
  using Weights = Eigen::Matrix<double, 1, kSize>;

  /// Residual X_to - X_from step, weighted by columns: tau, then kappa.
  struct Link {
    Eigen::Index from, to;
    Block step;
    Weights weights;
    Block block() const { return -step * weights.asDiagonal(); }  ///< of M, `from` by `to`
  };

  /// O(edges), and one minimum-degree ordering of the keyframes.
  explicit ChordalMatrix(const Problem& problem)
      : size_(static_cast<Eigen::Index>(problem.keyframes.size())),
        diagonal_(problem.keyframes.size(), Block::Zero()),
        structure_(structure_of(problem)) {
    for (const Edge& edge : problem.odometry) add(edge);
    for (const Edge& edge : problem.closures) add(edge);
  }

  Eigen::Index size() const { return size_; }  ///< keyframes
  const Block& diagonal(Eigen::Index i) const { return diagonal_[static_cast<std::size_t>(i)]; }
  /// Of symmetric matrices with a block per keyframe, such as M.
  const methods::EliminationStructure& structure() const { return structure_; }

  /// Poses as columns of X. In the plane of keyframe 0 if D is 2.
  static Poses columns(const Trajectory& keyframes) {
    Poses X(D, kSize * static_cast<Eigen::Index>(keyframes.size()));
    const Pose first_from_world = keyframes.front().world_from_body.inverse();
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      const Pose pose = first_from_world * keyframes[i].world_from_body;
      const Eigen::Index at = kSize * static_cast<Eigen::Index>(i);
      X.col(at) = pose.translation.template head<D>();
      X.template middleCols<D>(at + 1) = matrix(pose.rotation);
    }
    return X;
  }

  /// X M and the cost, summed over the residuals of the edges: the product would cancel digits.
  struct Product {
    Poses XM;
    double cost = 0.0;
  };

  /// O(edges).
  Product times(const Poses& X) const {
    Product out{Poses::Zero(D, X.cols()), 0.0};
    for (const Link& link : links_) {
      const auto from = X.template middleCols<kSize>(kSize * link.from);
      const auto to = X.template middleCols<kSize>(kSize * link.to);
      Eigen::Matrix<double, D, kSize> residual = to - from * link.step;
      out.cost += link.weights.dot(residual.colwise().squaredNorm());
      residual *= link.weights.asDiagonal();
      out.XM.template middleCols<kSize>(kSize * link.to) += residual;
      out.XM.template middleCols<kSize>(kSize * link.from) -= residual * link.step.transpose();
    }
    return out;
  }

  /// Multipliers of R_i' R_i = I at X: the symmetric parts of R_i' (X M)_i.
  std::vector<Rotation> multipliers(const Poses& X, const Poses& XM) const {
    std::vector<Rotation> out;
    out.reserve(diagonal_.size());
    for (Eigen::Index i = 0; i < size_; ++i) {
      const Eigen::Index at = kSize * i + 1;
      const Rotation G = X.template middleCols<D>(at).transpose() * XM.template middleCols<D>(at);
      out.push_back(0.5 * (G + G.transpose()));
    }
    return out;
  }

  /// Sets `out` to the symmetric matrix with the blocks `diagonal(i)` and `off_diagonal(link)`.
  template <int N, class Diagonal, class OffDiagonal>
  void assemble(methods::BlockCholesky<N>& out,
                Diagonal diagonal_block,
                OffDiagonal off_diagonal) const {
    out.set_zero();
    for (int i = 0; i < static_cast<int>(size_); ++i)
      out.add(out.location(i, i), diagonal_block(i));
    for (const Link& link : links_) {
      out.add(out.location(static_cast<int>(link.from), static_cast<int>(link.to)),
              off_diagonal(link));
    }
  }

 private:
  static Rotation matrix(const loopbench::Rotation& rotation) {
    if constexpr (D == 3) {
      return rotation.toRotationMatrix();
    } else {
      return Eigen::Rotation2Dd(2.0 * std::atan2(rotation.z(), rotation.w())).toRotationMatrix();
    }
  }

  void add(const Edge& edge) {
    const auto [kappa, tau] = chordal_weights(edge, D == 2);
    Link link{static_cast<Eigen::Index>(edge.from),
              static_cast<Eigen::Index>(edge.to),
              Block::Zero(),
              Weights::Constant(kappa)};
    link.weights[0] = tau;
    link.step(0, 0) = 1.0;
    link.step.col(0).template tail<D>() = edge.from_from_to.translation.template head<D>();
    link.step.template bottomRightCorner<D, D>() = matrix(edge.from_from_to.rotation);
    diagonal_.at(edge.from) += link.step * link.weights.asDiagonal() * link.step.transpose();
    diagonal_.at(edge.to).diagonal() += link.weights.transpose();
    links_.push_back(link);
  }

  static methods::EliminationStructure structure_of(const Problem& problem) {
    std::vector<std::pair<int, int>> pairs;
    for (const std::vector<Edge>* edges : {&problem.odometry, &problem.closures}) {
      for (const Edge& edge : *edges) {
        pairs.emplace_back(static_cast<int>(edge.from), static_cast<int>(edge.to));
      }
    }
    return {static_cast<int>(problem.keyframes.size()), pairs};
  }

  Eigen::Index size_;
  std::vector<Block> diagonal_;
  std::vector<Link> links_;
  methods::EliminationStructure structure_;
};

}  // namespace loopbench::metrics
