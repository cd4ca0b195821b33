#include "methods/solvers/selected_inverse.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <span>
#include <stdexcept>

namespace loopbench::methods {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

/// Approximate minimum degree of the graph of the blocks, for all rows.
Permutation ordering(const Sparse& lower, Eigen::Index block) {
  const Eigen::Index blocks = lower.rows() / block;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index j = 0; j < blocks; ++j) {
    for (Sparse::InnerIterator at(lower, j * block); at; ++at) {
      if (at.row() % block != 0) continue;
      const auto row = static_cast<int>(at.row() / block);
      entries.emplace_back(row, static_cast<int>(j), 1.0);
      entries.emplace_back(static_cast<int>(j), row, 1.0);
    }
  }
  Sparse pattern(blocks, blocks);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Permutation old_from_new;
  Eigen::AMDOrdering<int>()(pattern, old_from_new);
  Permutation out(lower.rows());
  for (Eigen::Index k = 0; k < lower.rows(); ++k) {
    const Eigen::Index row = old_from_new.indices()[k / block] * block + k % block;
    out.indices()[row] = static_cast<int>(k);
  }
  return out;  // new from old
}

/// Part of a column of blocks of the inverse, from its diagonal: that on the pattern of the factor.
struct Column {
  std::vector<Eigen::Index> rows;  ///< ascending block rows; the first is the column itself
  Eigen::MatrixXd values;          ///< one block per row
};

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

}  // namespace

std::vector<Eigen::MatrixXd> inverse_diagonal_blocks(const Sparse& lower, Eigen::Index block) {
  const Eigen::Index blocks = lower.rows() / block;
  std::vector<Eigen::MatrixXd> out(static_cast<std::size_t>(blocks));
  if (blocks == 0) return out;
  const Permutation new_from_old = ordering(lower, block);
  Sparse permuted(lower.rows(), lower.cols());
  permuted.selfadjointView<Eigen::Lower>() =
      lower.selfadjointView<Eigen::Lower>().twistedBy(new_from_old);
  const Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> cholesky(permuted);
  if (cholesky.info() != Eigen::Success) {
    throw std::runtime_error("covariances: the information matrix is not positive definite");
  }
  const Sparse& factor = cholesky.matrixL().nestedExpression();
  std::vector<Column> inverse(static_cast<std::size_t>(blocks));
  for (Eigen::Index j = blocks; j-- > 0;) {
    Column column = factor_column(factor, j, block);
    const Eigen::MatrixXd own = column.values.topRows(block).triangularView<Eigen::Lower>().solve(
        Eigen::MatrixXd::Identity(block, block));
    const Eigen::Index rest = column.values.rows() - block;
    // With L = [D; S], the inverse of D' D plus the part of the later columns.
    const Eigen::MatrixXd weights = column.values.bottomRows(rest) * own;
    const std::span<const Eigen::Index> separator(column.rows.begin() + 1, column.rows.end());
    const Eigen::MatrixXd later = gathered(inverse, separator, block);
    column.values.bottomRows(rest).noalias() = -(later.selfadjointView<Eigen::Lower>() * weights);
    Eigen::MatrixXd diagonal = own.transpose() * own;
    diagonal.noalias() -= weights.transpose() * column.values.bottomRows(rest);
    column.values.topRows(block) = 0.5 * (diagonal + diagonal.transpose());
    inverse[static_cast<std::size_t>(j)] = std::move(column);
  }
  for (Eigen::Index i = 0; i < blocks; ++i) {
    const auto j = static_cast<std::size_t>(new_from_old.indices()[i * block] / block);
    out[static_cast<std::size_t>(i)] = inverse[j].values.topRows(block);
  }
  return out;
}

}  // namespace loopbench::methods
