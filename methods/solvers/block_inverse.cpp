#include "methods/solvers/block_cholesky.hpp"
#include "methods/solvers/panel_kernels.hpp"

namespace loopbench::methods {

/// The inverse at the rows below a supernode, lower triangle: the supernode of each of these
/// columns has all of these rows that follow it.
template <int D>
void BlockCholesky<D>::gather_inverse(const Supernode& of, Eigen::MatrixXd& lower) const {
  const int* rows = structure_.rows_below(of);
  lower.resize(of.below * D, of.below * D);
  for (int c = 0; c < of.below; ++c) {
    const auto s = static_cast<std::size_t>(structure_.supernode_of(rows[c]));
    const Supernode& node = structure_.supernodes()[s];
    const int* below = structure_.rows_below(node);
    const Eigen::Index height = node.rows() * D;
    const double* column = values_.data() + panel_[s] + (rows[c] - node.first) * D * height;
    int at = 0;
    for (int r = c; r < of.below; ++r) {
      int row = rows[r] - node.first;
      if (rows[r] >= node.end) {
        while (below[at] != rows[r]) ++at;
        row = node.columns() + at;
      }
      lower.block<D, D>(r * D, c * D) = Eigen::Map<const Block, 0, Eigen::OuterStride<>>(
          column + row * D, Eigen::OuterStride<>(height));
    }
  }
}

template <int D>
void BlockCholesky<D>::invert() {
  Eigen::MatrixXd later, own, weights;
  for (std::size_t s = count(); s-- > 0;) {
    const Supernode& node = structure_.supernodes()[s];
    const Eigen::Index width = node.columns() * D, height = node.rows() * D;
    double* const panel = values_.data() + panel_[s];
    DensePanel top = dense_panel(panel, width, width, height);
    DensePanel below = dense_panel(panel + width, height - width, width, height);
    own = Eigen::MatrixXd::Identity(width, width);
    top.template triangularView<Eigen::Lower>().solveInPlace(own);
    if (node.below == 0) {
      top.noalias() = own.transpose() * own;
      continue;
    }
    // With L = [D; B] and Z of the rows below: -Z B D^-1, and D'^-1 D^-1 + (B D^-1)' Z B D^-1.
    weights.noalias() = below * own;
    gather_inverse(node, later);
    below.noalias() = later.selfadjointView<Eigen::Lower>() * weights;
    top.noalias() = own.transpose() * own;
    top.noalias() += weights.transpose() * below;
    below *= -1.0;
  }
}

template <int D>
typename BlockCholesky<D>::Block BlockCholesky<D>::inverse_block(const Location& at) const {
  const Eigen::Map<const Block, 0, Eigen::OuterStride<>> stored(values_.data() + at.offset,
                                                                Eigen::OuterStride<>(at.stride));
  return at.is_transposed ? Block(stored.transpose()) : Block(stored);
}

template void BlockCholesky<3>::invert();
template void BlockCholesky<6>::invert();
template BlockCholesky<3>::Block BlockCholesky<3>::inverse_block(const Location& at) const;
template BlockCholesky<6>::Block BlockCholesky<6>::inverse_block(const Location& at) const;

}  // namespace loopbench::methods
