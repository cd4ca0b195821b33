/// Data matrix of the isotropic chordal cost of a pose graph, in blocks of keyframes.
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <vector>

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
  using Sparse = Eigen::SparseMatrix<double>;
  using Factor = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

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
        diagonal_(problem.keyframes.size(), Block::Zero()) {
    for (const Edge& edge : problem.odometry) add(edge);
    for (const Edge& edge : problem.closures) add(edge);
    order();
  }

  Eigen::Index size() const { return size_; }  ///< keyframes
  const std::vector<Link>& links() const { return links_; }
  const Block& diagonal(Eigen::Index i) const { return diagonal_[static_cast<std::size_t>(i)]; }
  /// Position of a keyframe in the order of elimination.
  Eigen::Index position(Eigen::Index i) const { return position_[static_cast<std::size_t>(i)]; }

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

  /// Lower triangle, in the order of elimination, of a symmetric matrix with the blocks
  /// `diagonal(i)` and `off_diagonal(link)`.
  template <int N, class Diagonal, class OffDiagonal>
  Sparse assemble(Diagonal diagonal_block, OffDiagonal off_diagonal) const {
    using Entry = Eigen::Triplet<double>;
    std::vector<Entry> entries;
    entries.reserve((diagonal_.size() + links_.size()) * N * N);
    const auto add_entry = [&entries](Eigen::Index row, Eigen::Index column, double value) {
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
    };
    for (Eigen::Index i = 0; i < size_; ++i) {
      const Eigen::Matrix<double, N, N> block = diagonal_block(i);
      for (int c = 0; c < N; ++c) {
        for (int r = c; r < N; ++r)
          add_entry(N * position(i) + r, N * position(i) + c, block(r, c));
      }
    }
    for (const Link& link : links_) {
      const Eigen::Matrix<double, N, N> block = off_diagonal(link);
      const Eigen::Index from = N * position(link.from);
      const Eigen::Index to = N * position(link.to);
      for (int c = 0; c < N; ++c) {
        for (int r = 0; r < N; ++r) {
          add_entry(std::max(from + r, to + c), std::min(from + r, to + c), block(r, c));
        }
      }
    }
    Sparse out(N * size_, N * size_);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
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

  void order() {
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < size_; ++i) {
      entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
    }
    for (const Link& link : links_) {
      entries.emplace_back(static_cast<int>(link.from), static_cast<int>(link.to), 1.0);
      entries.emplace_back(static_cast<int>(link.to), static_cast<int>(link.from), 1.0);
    }
    Sparse graph(size_, size_);
    graph.setFromTriplets(entries.begin(), entries.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(graph, order);
    position_.resize(diagonal_.size());
    for (Eigen::Index k = 0; k < size_; ++k) {
      position_[static_cast<std::size_t>(order.indices()[k])] = k;
    }
  }

  Eigen::Index size_;
  std::vector<Block> diagonal_;
  std::vector<Link> links_;
  std::vector<Eigen::Index> position_;
};

}  // namespace loopbench::metrics
