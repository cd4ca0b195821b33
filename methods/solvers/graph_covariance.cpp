#include "methods/solvers/graph_covariance.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "methods/solvers/elimination_structure.hpp"
#include "methods/solvers/groups/visit_group.hpp"

namespace loopbench::methods {
namespace {

/// Position of each row in the order of elimination of the blocks.
Permutation ordering(const Sparse& lower, Eigen::Index block) {
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

/// The factor's column of blocks `j`, with zeros above the diagonal.
Column factor_column(const Sparse& factor, Eigen::Index j, Eigen::Index block) {
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
Eigen::MatrixXd gathered(const std::vector<Column>& inverse,
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

template <class G>
std::vector<Matrix6> covariances_in(const std::vector<ScaledPose>& poses,
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

}  // namespace

SelectedInverse::SelectedInverse(const Sparse& lower, Eigen::Index block)
    : block_(block), new_from_old_(ordering(lower, block)) {
  const Eigen::Index blocks = lower.rows() / block;
  Sparse permuted(lower.rows(), lower.cols());
  permuted.selfadjointView<Eigen::Lower>() =
      lower.selfadjointView<Eigen::Lower>().twistedBy(new_from_old_);
  const Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(permuted);
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

Eigen::MatrixXd SelectedInverse::block(Eigen::Index i, Eigen::Index j) const {
  const Eigen::Index a = position(i), b = position(j);
  const Column& column = inverse_[static_cast<std::size_t>(std::min(a, b))];
  const auto found = std::ranges::lower_bound(column.rows, std::max(a, b));
  const Eigen::MatrixXd out =
      column.values.middleRows((found - column.rows.begin()) * block_, block_);
  return a >= b ? out : Eigen::MatrixXd(out.transpose());
}

std::vector<Eigen::MatrixXd> inverse_diagonal_blocks(const Sparse& lower, Eigen::Index block) {
  const Eigen::Index blocks = lower.rows() / block;
  std::vector<Eigen::MatrixXd> out;
  if (blocks == 0) return out;
  const SelectedInverse inverse(lower, block);
  for (Eigen::Index i = 0; i < blocks; ++i) out.push_back(inverse.block(i, i));
  return out;
}

std::vector<Matrix6> graph_covariances(const std::vector<ScaledPose>& poses,
                                       const WeightedEdges& edges,
                                       const PoseGraphSettings& settings) {
  if (poses.empty()) return {};
  return visit_group(settings.group,
                     [&]<class G>(G) { return covariances_in<G>(poses, edges, settings); });
}

}  // namespace loopbench::methods
