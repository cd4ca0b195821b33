#include "methods/solvers/block_cholesky.hpp"

#include <algorithm>
#include <utility>

#include "methods/solvers/panel_kernels.hpp"

namespace loopbench::methods {

template <int D>
BlockCholesky<D>::BlockCholesky(const EliminationStructure& structure, Eigen::VectorXd storage)
    : structure_(structure),
      values_(std::move(storage)),
      cleared_for_(structure.supernodes().size(), -1),
      children_(structure.supernodes().size()) {
  std::size_t size = 0;
  std::size_t top = 0;
  std::size_t highest = 0;
  int most_rows = 0;
  for (std::size_t s = 0; s < children_.size(); ++s) {
    const Supernode& node = structure.supernodes()[s];
    panel_.push_back(size);
    size +=
        static_cast<std::size_t>(node.rows() * D) * static_cast<std::size_t>(node.columns() * D);
    const auto side = static_cast<std::size_t>(node.below * D);
    highest = std::max(highest, top + side * side);
    update_.push_back(children_[s].empty() ? top : update_[children_[s].front()]);
    top = update_[s] + side * side;
    most_rows = std::max(most_rows, node.below);
    if (node.parent < 0) continue;
    const auto parent = static_cast<std::size_t>(node.parent);
    children_[parent].push_back(s);
    for (int r = 0; r < node.below; ++r) {
      row_in_parent_.push_back(
          structure.row_in(structure.supernodes()[parent], structure.rows_below(node)[r]));
    }
  }
  panel_.push_back(size);
  const auto needed = static_cast<Eigen::Index>(size);
  if (values_.size() < needed) {
    const bool is_growing = values_.size() > 0;
    values_.resize(is_growing ? needed + needed / 4 : needed);
  }
  stack_.resize(highest);
  gathered_.resize(most_rows * D);
  ordered_.resize(structure.blocks() * D);
}

template <int D>
typename BlockCholesky<D>::Place BlockCholesky<D>::place(int i, int j) const {
  const int row = std::max(structure_.position(i), structure_.position(j));
  const int column = std::min(structure_.position(i), structure_.position(j));
  const int s = structure_.supernode_of(column);
  const Supernode& node = structure_.supernodes()[static_cast<std::size_t>(s)];
  const int stride = node.rows() * D;
  const Eigen::Index offset =
      Eigen::Index{column - node.first} * D * stride + structure_.row_in(node, row) * D;
  return {panel_[static_cast<std::size_t>(s)] + static_cast<std::size_t>(offset),
          stride,
          s,
          structure_.position(i) < structure_.position(j)};
}

template <int D>
void BlockCholesky<D>::clear(std::size_t supernode) {
  if (std::exchange(cleared_for_[supernode], matrix_) == matrix_) return;
  std::fill(values_.data() + panel_[supernode], values_.data() + panel_[supernode + 1], 0.0);
}

template <int D>
void BlockCholesky<D>::add(const Place& at, const Block& block) {
  clear(static_cast<std::size_t>(at.supernode));
  Eigen::Map<Block, 0, Eigen::OuterStride<>> to(values_.data() + at.offset,
                                                Eigen::OuterStride<>(at.stride));
  if (at.is_transposed) {
    to += block.transpose();
  } else {
    to += block;
  }
}

template <int D>
void BlockCholesky<D>::add_update(const double* from,
                                  std::size_t child,
                                  double* panel,
                                  double* update) {
  const Supernode& node = structure_.supernodes()[child];
  const Supernode& parent = structure_.supernodes()[static_cast<std::size_t>(node.parent)];
  const int* rows = row_in_parent_.data() + node.offset;
  const Eigen::Index side = node.below * D;
  for (int column = 0; column < node.below; ++column) {
    const int to = rows[column];
    const bool is_pivot = to < parent.columns();
    const Eigen::Index stride = (is_pivot ? parent.rows() : parent.below) * D;
    const int shift = is_pivot ? 0 : parent.columns();
    double* target = (is_pivot ? panel : update) + (to - shift) * D * stride - shift * D;
    for (int begin = column, end = column; begin < node.below; begin = end) {
      do ++end;
      while (end < node.below && rows[end] == rows[end - 1] + 1);
      const Eigen::Index height = (end - begin) * D;
      for (int d = 0; d < D; ++d) {
        const double* source = from + (column * D + d) * side + begin * D;
        double* sum = target + d * stride + rows[begin] * D;
        for (Eigen::Index r = 0; r < height; ++r) sum[r] += source[r];
      }
    }
  }
}

template <int D>
template <class Before, class After>
bool BlockCholesky<D>::eliminate(Before before, After after) {
  for (std::size_t s = 0; s < children_.size(); ++s) {
    clear(s);
    before(s);
    const Supernode& node = structure_.supernodes()[s];
    const auto side = static_cast<std::size_t>(node.below * D);
    double* panel = values_.data() + panel_[s];
    std::size_t top = update_[s];  // above the updates of the children
    if (!children_[s].empty()) {
      const std::size_t last = children_[s].back();
      const auto last_side = static_cast<std::size_t>(structure_.supernodes()[last].below * D);
      top = update_[last] + last_side * last_side;
    }
    double* update = stack_.data() + top;
    std::fill(update, update + side * side, 0.0);
    for (const std::size_t child : children_[s]) {
      add_update(stack_.data() + update_[child], child, panel, update);
    }
    if (!eliminate_panel<D>(panel, node.columns(), node.rows())) return false;
    after(s);
    if (side == 0) continue;
    subtract_products<D>(update, panel, node.columns(), node.rows());
    if (top != update_[s]) std::copy(update, update + side * side, stack_.data() + update_[s]);
  }
  return true;
}

template <int D>
void BlockCholesky<D>::order(const double* right) {
  for (int i = 0; i < structure_.blocks(); ++i) {
    std::copy(right + i * D, right + (i + 1) * D, ordered_.data() + structure_.position(i) * D);
  }
}

template <int D>
void BlockCholesky<D>::forward(std::size_t supernode) {
  const Supernode& node = structure_.supernodes()[supernode];
  gathered_.head(node.below * D).setZero();
  solve_forward(values_.data() + panel_[supernode],
                node.columns() * D,
                node.rows() * D,
                ordered_.data() + node.first * D,
                gathered_.data());
  const int* rows = structure_.rows_below(node);
  for (int r = 0; r < node.below; ++r) {
    ordered_.segment<D>(rows[r] * D) += gathered_.segment<D>(r * D);
  }
}

template <int D>
void BlockCholesky<D>::backward(double* right) {
  for (std::size_t s = children_.size(); s-- > 0;) {
    const Supernode& node = structure_.supernodes()[s];
    const int* rows = structure_.rows_below(node);
    for (int r = 0; r < node.below; ++r) {
      gathered_.segment<D>(r * D) = ordered_.segment<D>(rows[r] * D);
    }
    solve_backward(values_.data() + panel_[s],
                   node.columns() * D,
                   node.rows() * D,
                   ordered_.data() + node.first * D,
                   gathered_.data());
  }
  for (int i = 0; i < structure_.blocks(); ++i) {
    const double* from = ordered_.data() + structure_.position(i) * D;
    std::copy(from, from + D, right + i * D);
  }
}

template <int D>
bool BlockCholesky<D>::factorise() {
  const auto nothing = [](std::size_t) {};
  return eliminate(nothing, nothing);
}

template <int D>
void BlockCholesky<D>::solve(Eigen::MatrixXd& right) {
  for (Eigen::Index column = 0; column < right.cols(); ++column) {
    order(right.col(column).data());
    for (std::size_t s = 0; s < children_.size(); ++s) forward(s);
    backward(right.col(column).data());
  }
}

template <int D>
bool BlockCholesky<D>::solve_damped(double damping,
                                    Eigen::VectorXd& diagonal,
                                    Eigen::VectorXd& right) {
  diagonal.resize(structure_.blocks() * D);
  const auto scale = [&](std::size_t s) {
    const Supernode& node = structure_.supernodes()[s];
    double* entry = values_.data() + panel_[s];
    for (int i = node.first * D; i < node.end * D; ++i, entry += node.rows() * D + 1) {
      diagonal[i] = *entry;
      *entry *= 1.0 + damping;
    }
  };
  order(right.data());
  if (!eliminate(scale, [&](std::size_t s) { forward(s); })) return false;
  backward(right.data());
  return true;
}

template class BlockCholesky<1>;
template class BlockCholesky<2>;
template class BlockCholesky<3>;
template class BlockCholesky<4>;
template class BlockCholesky<6>;
template class BlockCholesky<7>;

}  // namespace loopbench::methods
