/// Covariances of the poses of a solved pose graph.
#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::methods {

using Sparse = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

/// Part of a column of blocks of the inverse, from its diagonal: that on the pattern of the factor.
struct Column {
  std::vector<Eigen::Index> rows;  ///< ascending block rows; the first is the column itself
  Eigen::MatrixXd values;          ///< one block per row
};

/// The inverse of a symmetric positive definite matrix, on the pattern of its Cholesky factor,
/// which contains that of the matrix. `lower` is its lower triangle in complete blocks of size
/// `block`: every stored block has all entries, zeros included, except above the diagonal.
///
/// The entries of the inverse on the pattern of the Cholesky factor are computed from the last
/// column to the first, because each depends only on entries of later columns on this pattern. Time
/// and memory are those of the factorisation, up to a constant. The constructor throws
/// std::runtime_error if the matrix is not positive definite.
///
/// Source: K. Takahashi, J. Fagan, M.-S. Chin, Formation of a sparse bus impedance matrix, 1973;
/// A. M. Erisman, W. F. Tinney, On computing certain elements of the inverse of a sparse matrix,
/// CACM 18(3), 1975.
class SelectedInverse {
 public:
  SelectedInverse(const Sparse& lower, Eigen::Index block);

  /// Block (i, j) of the inverse, of the matrix's pattern. O(log rows).
  Eigen::MatrixXd block(Eigen::Index i, Eigen::Index j) const;

 private:
  Eigen::Index position(Eigen::Index block) const {
    return new_from_old_.indices()[block * block_] / block_;
  }

  Eigen::Index block_;
  Permutation new_from_old_;
  std::vector<Column> inverse_;
};

/// Returns the blocks on the diagonal of the inverse, see SelectedInverse.
std::vector<Eigen::MatrixXd> inverse_diagonal_blocks(const Sparse& lower, Eigen::Index block);

/// Lower triangle of the information matrix over the poses from `first` on, in complete blocks.
template <class G>
class Information {
 public:
  explicit Information(std::size_t first) : first_(first) {}

  void add(std::size_t row, std::size_t column, const typename G::Square& block) {
    if (row < first_ || column < first_) return;
    for (int r = 0; r < G::kDof; ++r) {
      for (int c = 0; c < G::kDof; ++c) {
        if (row == column && r < c) continue;
        entries_.emplace_back(index(row) + r, index(column) + c, block(r, c));
      }
    }
  }

  Eigen::SparseMatrix<double> matrix(std::size_t poses) const {
    Eigen::SparseMatrix<double> out(index(poses), index(poses));
    out.setFromTriplets(entries_.begin(), entries_.end());
    return out;
  }

 private:
  int index(std::size_t pose) const { return G::kDof * static_cast<int>(pose - first_); }

  std::size_t first_;
  std::vector<Eigen::Triplet<double>> entries_;
};

/// Information of an anchor about d in X Exp(d).
template <class G>
inline typename G::Square anchor_information(const Anchor& anchor, const Pose& world_from_body) {
  const AnchorResidual at = anchor_residual(anchor, world_from_body);
  Eigen::Matrix<double, 3, G::kDof> J = Eigen::Matrix<double, 3, G::kDof>::Zero();
  for (int i = 0; i < std::min(G::kDof, 6); ++i) J.col(i) = at.by_pose.col(twist_axis<G>(i));
  return J.transpose() * anchor.covariance.inverse() * J;
}

/// Information over the poses from `first` on, about d in X Exp(d). Twists are relative to each
/// pose, so that the world frame does not matter.
template <class G>
inline Information<G> graph_information(const std::vector<ScaledPose>& poses,
                                        const WeightedEdges& edges,
                                        const PoseGraphSettings& settings,
                                        std::size_t first) {
  const ScaledPose first_from_world = poses.front().inverse();
  Information<G> information(first);
  edges.for_each([&](const Edge& edge, double weight, bool is_closure) {
    const EdgeResidual<G> at = edge_residual<G>(G::inverse(G::from(measured(edge))),
                                                G::from(first_from_world * poses[edge.from]),
                                                G::from(first_from_world * poses[edge.to]));
    typename G::Square omega = weight * G::information(edge, settings.scale_sigma);
    if (is_closure) omega *= loss_derivative(settings, at.error.dot(omega * at.error));
    information.add(edge.from, edge.from, at.by_from.transpose() * omega * at.by_from);
    information.add(edge.to, edge.to, at.by_to.transpose() * omega * at.by_to);
    information.add(edge.to, edge.from, at.by_to.transpose() * omega * at.by_from);
  });
  return information;
}

/// Returns the covariance of each pose in fixed axes (datasets/core/covariance.hpp), to first order
/// at `poses`, the minimum of solve_pose_graph() with the same arguments: blocks on the diagonal of
/// the inverse of sum w rho' J' Omega J, with the information of the anchors. It is zero for pose 0
/// unless `is_first_free`. In SE(2), poses have no errors out of the plane: these covariances are
/// zero. In Sim(3), that of the scale is left out. Time and memory of one factorisation. Throws
/// std::runtime_error if the information is not positive definite.
std::vector<Matrix6> graph_covariances(const std::vector<ScaledPose>& poses,
                                       const WeightedEdges& edges,
                                       const PoseGraphSettings& settings);

}  // namespace loopbench::methods
