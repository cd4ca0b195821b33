/// Covariances of the poses of a solved pose graph.
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "datasets/core/covariance.hpp"
#include "methods/solvers/elimination_structure.hpp"
#include "methods/solvers/groups/visit_group.hpp"
#include "methods/solvers/pose_graph_solver.hpp"
#include "methods/solvers/residuals.hpp"

namespace loopbench::methods {

using Sparse = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

/// Position of each row in the order of elimination of the blocks.
inline Permutation ordering(const Sparse& lower, Eigen::Index block) {
  std::vector<std::pair<int, int>> pairs;
  const Eigen::Index blocks = lower.rows() / block;
  for (Eigen::Index j = 0; j < blocks; ++j) {
    for (Sparse::InnerIterator at(lower, j * block); at; ++at) {
      if (at.row() % block == 0) pairs.emplace_back(at.row() / block, j);
    }
  }
  const std::vector<int> position = minimum_degree(static_cast<int>(blocks), pairs);
  Permutation out(lower.rows());
  for (Eigen::Index row = 0; row < lower.rows(); ++row) {
    const int first = position[static_cast<std::size_t>(row / block)] * static_cast<int>(block);
    out.indices()[row] = first + static_cast<int>(row % block);
  }
  return out;
}

/// Part of a column of blocks of the inverse, from its diagonal: that on the pattern of the factor.
struct Column {
  std::vector<Eigen::Index> rows;  ///< ascending block rows; the first is the column itself
  Eigen::MatrixXd values;          ///< one block per row
};

/// The factor's column of blocks `j`, with zeros above the diagonal.
inline Column factor_column(const Sparse& factor, Eigen::Index j, Eigen::Index block) {
  Column out;
  for (Sparse::InnerIterator at(factor, j * block); at; ++at) {
    if (at.row() % block == 0) out.rows.push_back(at.row() / block);
  }
  out.values = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(out.rows.size()) * block, block);
  for (Eigen::Index c = 0; c < block; ++c) {
    Eigen::Index row = c;
    for (Sparse::InnerIterator at(factor, j * block + c); at; ++at) {
      out.values(row++, c) = at.value();
    }
  }
  return out;
}

/// The inverse at the rows and columns of `separator`, lower triangle: its columns contain all of
/// these rows, because these poses are connected when the first of them is eliminated.
inline Eigen::MatrixXd gathered(const std::vector<Column>& inverse,
                                std::span<const Eigen::Index> separator,
                                Eigen::Index block) {
  const auto size = static_cast<Eigen::Index>(separator.size()) * block;
  Eigen::MatrixXd out(size, size);
  for (std::size_t b = 0; b < separator.size(); ++b) {
    const Column& column = inverse[static_cast<std::size_t>(separator[b])];
    std::size_t k = 0;
    for (std::size_t a = b; a < separator.size(); ++a) {
      while (column.rows[k] != separator[a]) ++k;
      out.block(static_cast<Eigen::Index>(a) * block,
                static_cast<Eigen::Index>(b) * block,
                block,
                block) = column.values.middleRows(static_cast<Eigen::Index>(k) * block, block);
    }
  }
  return out;
}

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
  SelectedInverse(const Sparse& lower, Eigen::Index block)
      : block_(block), new_from_old_(ordering(lower, block)) {
    const Eigen::Index blocks = lower.rows() / block;
    Sparse permuted(lower.rows(), lower.cols());
    permuted.selfadjointView<Eigen::Lower>() =
        lower.selfadjointView<Eigen::Lower>().twistedBy(new_from_old_);
    const Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(
        permuted);
    if (cholesky.info() != Eigen::Success) {
      throw std::runtime_error("covariances: the information matrix is not positive definite");
    }
    const Sparse& factor = cholesky.matrixL().nestedExpression();
    inverse_.resize(static_cast<std::size_t>(blocks));
    for (Eigen::Index j = blocks; j-- > 0;) {
      Column column = factor_column(factor, j, block);
      const Eigen::MatrixXd own = column.values.topRows(block).triangularView<Eigen::Lower>().solve(
          Eigen::MatrixXd::Identity(block, block));
      const Eigen::Index rest = column.values.rows() - block;
      // With L = [D; S], the inverse of D' D plus the part of the later columns.
      const Eigen::MatrixXd weights = column.values.bottomRows(rest) * own;
      const std::span<const Eigen::Index> separator(column.rows.begin() + 1, column.rows.end());
      const Eigen::MatrixXd later = gathered(inverse_, separator, block);
      column.values.bottomRows(rest).noalias() = -(later.selfadjointView<Eigen::Lower>() * weights);
      Eigen::MatrixXd diagonal = own.transpose() * own;
      diagonal.noalias() -= weights.transpose() * column.values.bottomRows(rest);
      column.values.topRows(block) = 0.5 * (diagonal + diagonal.transpose());
      inverse_[static_cast<std::size_t>(j)] = std::move(column);
    }
  }

  /// Block (i, j) of the inverse, of the matrix's pattern. O(log rows).
  Eigen::MatrixXd block(Eigen::Index i, Eigen::Index j) const {
    const Eigen::Index a = position(i), b = position(j);
    const Column& column = inverse_[static_cast<std::size_t>(std::min(a, b))];
    const auto found = std::ranges::lower_bound(column.rows, std::max(a, b));
    const Eigen::MatrixXd out =
        column.values.middleRows((found - column.rows.begin()) * block_, block_);
    return a >= b ? out : Eigen::MatrixXd(out.transpose());
  }

 private:
  Eigen::Index position(Eigen::Index block) const {
    return new_from_old_.indices()[block * block_] / block_;
  }

  Eigen::Index block_;
  Permutation new_from_old_;
  std::vector<Column> inverse_;
};

/// Returns the blocks on the diagonal of the inverse, see SelectedInverse.
inline std::vector<Eigen::MatrixXd> inverse_diagonal_blocks(const Sparse& lower,
                                                            Eigen::Index block) {
  const Eigen::Index blocks = lower.rows() / block;
  std::vector<Eigen::MatrixXd> out;
  if (blocks == 0) return out;
  const SelectedInverse inverse(lower, block);
  for (Eigen::Index i = 0; i < blocks; ++i) out.push_back(inverse.block(i, i));
  return out;
}

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

template <class G>
inline std::vector<Matrix6> covariances_in(const std::vector<ScaledPose>& poses,
                                           const WeightedEdges& edges,
                                           const PoseGraphSettings& settings) {
  const std::size_t first = settings.is_first_free ? 0 : 1;
  Information<G> information = graph_information<G>(poses, edges, settings, first);
  for (const Anchor& anchor : settings.anchors) {
    information.add(anchor.keyframe,
                    anchor.keyframe,
                    anchor_information<G>(anchor, poses[anchor.keyframe].pose));
  }
  const std::vector<Eigen::MatrixXd> blocks =
      inverse_diagonal_blocks(information.matrix(poses.size()), G::kDof);
  std::vector<Matrix6> out(poses.size(), Matrix6::Zero());
  for (std::size_t i = first; i < poses.size(); ++i) {
    Matrix6 of_twist = Matrix6::Zero();
    for (int r = 0; r < std::min(G::kDof, 6); ++r) {
      for (int c = 0; c < std::min(G::kDof, 6); ++c) {
        of_twist(twist_axis<G>(r), twist_axis<G>(c)) = blocks[i - first](r, c);
      }
    }
    const Pose& pose = poses[i].pose;
    const double scale = G::kDof == 7 ? poses[i].scale : 1.0;
    out[i] = rotated(of_twist, pose.rotation.toRotationMatrix(), scale);
  }
  return out;
}

/// Returns the covariance of each pose in fixed axes (datasets/core/covariance.hpp), to first order
/// at `poses`, the minimum of solve_pose_graph() with the same arguments: blocks on the diagonal of
/// the inverse of sum w rho' J' Omega J, with the information of the anchors. It is zero for pose 0
/// unless `is_first_free`. In SE(2), poses have no errors out of the plane: these covariances are
/// zero. In Sim(3), that of the scale is left out. Time and memory of one factorisation. Throws
/// std::runtime_error if the information is not positive definite.
inline std::vector<Matrix6> graph_covariances(const std::vector<ScaledPose>& poses,
                                              const WeightedEdges& edges,
                                              const PoseGraphSettings& settings) {
  if (poses.empty()) return {};
  return visit_group(settings.group,
                     [&]<class G>(G) { return covariances_in<G>(poses, edges, settings); });
}

}  // namespace loopbench::methods
