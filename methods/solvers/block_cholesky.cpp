#include "methods/solvers/block_cholesky.hpp"

#include <algorithm>
#include <utility>

#include "methods/solvers/panel_kernels.hpp"

namespace loopbench::methods {

constexpr std::size_t kPanelsAhead = 8;  // loaded before they are visited

template <int D>
BlockCholesky<D>::BlockCholesky(const EliminationStructure& structure)
    : structure_(structure), cleared_for_(structure.supernodes().size(), -1) {
  std::size_t size = 0;
  std::size_t highest = 0;
  int most_rows = 0;
  for (std::size_t s = 0; s < count(); ++s) {
    const Supernode& node = structure.supernodes()[s];
    panel_.push_back(size);
    size +=
        static_cast<std::size_t>(node.rows() * D) * static_cast<std::size_t>(node.columns() * D);
    highest = std::max(highest, top() + update_size(node));
    replace_children(s);
    most_rows = std::max(most_rows, node.below);
    if (node.parent < 0) continue;
    const Supernode& parent = structure.supernodes()[static_cast<std::size_t>(node.parent)];
    for (int r = 0; r < node.below; ++r) {
      row_in_parent_.push_back(structure.row_in(parent, structure.rows_below(node)[r]));
    }
  }
  panel_.push_back(size);
  values_.resize(static_cast<Eigen::Index>(size));
  stack_.resize(highest);
  gathered_.resize(most_rows * D);
  ordered_.resize(structure.blocks() * D);
}

template <int D>
typename BlockCholesky<D>::Location BlockCholesky<D>::location(int i, int j) const {
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
void BlockCholesky<D>::add(const Location& at, const Block& block) {
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
  constexpr int kFewRows = 4;
  for (int column = 0; column < node.below; ++column) {
    const int to = rows[column];
    const bool is_pivot = to < parent.columns();
    const Eigen::Index stride = (is_pivot ? parent.rows() : parent.below) * D;
    const int shift = is_pivot ? 0 : parent.columns();
    double* target = (is_pivot ? panel : update) + (to - shift) * D * stride - shift * D;
    if (node.below <= kFewRows) {  // most nodes of a chain
      for (int r = column; r < node.below; ++r) {
        const double* source = from + column * D * side + r * D;
        double* sum = target + rows[r] * D;
        for (int d = 0; d < D; ++d) {
          for (int k = 0; k < D; ++k) sum[d * stride + k] += source[d * side + k];
        }
      }
      continue;
    }
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

/// Loads a panel into the cache: on long chains the panels are in main memory. Without effect
/// beyond both ends.
template <int D>
void BlockCholesky<D>::prefetch(std::size_t supernode) const {
  constexpr std::size_t kLine = 64 / sizeof(double), kMost = 16 * kLine;
  if (supernode >= count()) return;
  const std::size_t end = std::min(panel_[supernode + 1], panel_[supernode] + kMost);
  for (std::size_t i = panel_[supernode]; i < end; i += kLine) {
    __builtin_prefetch(values_.data() + i, 1);
  }
}

template <int D>
std::size_t BlockCholesky<D>::first_child(std::size_t supernode) const {
  std::size_t i = waiting_.size();
  while (i > 0 &&
         structure_.supernodes()[waiting_[i - 1].supernode].parent == static_cast<int>(supernode)) {
    --i;
  }
  return i;
}

template <int D>
std::size_t BlockCholesky<D>::replace_children(std::size_t supernode) {
  const std::size_t first = first_child(supernode);
  const std::size_t begin = first < waiting_.size() ? waiting_[first].begin : top();
  waiting_.resize(first);
  const std::size_t size = update_size(structure_.supernodes()[supernode]);
  if (size > 0) waiting_.push_back({supernode, begin, begin + size});
  return begin;
}

template <int D>
template <class Before, class After>
bool BlockCholesky<D>::eliminate(Before before, After after) {
  waiting_.clear();
  for (std::size_t s = 0; s < count(); ++s) {
    prefetch(s + kPanelsAhead);
    clear(s);
    before(s);
    const Supernode& node = structure_.supernodes()[s];
    const std::size_t size = update_size(node);
    double* panel = values_.data() + panel_[s];
    double* update = stack_.data() + top();
    std::fill(update, update + size, 0.0);
    for (std::size_t i = first_child(s); i < waiting_.size(); ++i) {
      add_update(stack_.data() + waiting_[i].begin, waiting_[i].supernode, panel, update);
    }
    if (!eliminate_panel<D>(panel, node.columns(), node.rows())) return false;
    after(s);
    if (size > 0) subtract_products<D>(update, panel, node.columns(), node.rows());
    double* begin = stack_.data() + replace_children(s);
    if (begin != update) std::copy(update, update + size, begin);
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
  for (std::size_t s = count(); s-- > 0;) {
    prefetch(s - kPanelsAhead);
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
    for (std::size_t s = 0; s < count(); ++s) forward(s);
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
