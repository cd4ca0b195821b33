/// Symbolic Cholesky factorisation of a sparse symmetric matrix of blocks.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace loopbench::methods {

/// Returns for each block its position in the order of approximate minimum degree (Eigen). `pairs`
/// are the blocks off the diagonal, in any order; repeated pairs are allowed. Deterministic.
std::vector<int> minimum_degree(int blocks, const std::vector<std::pair<int, int>>& pairs);

/// Order in which the blocks of a matrix are eliminated, and where its factor has blocks. Blocks
/// whose columns of the factor have nearly the same rows form a supernode, which is stored and
/// eliminated as one dense matrix; a few stored zeros are cheaper than small matrices.
class EliminationStructure {
 public:
  /// Consecutive columns [first, end) of the factor. Their common rows below are rows of this
  /// class, indices offset .. offset + below.
  struct Supernode {
    int first = 0;
    int end = 0;
    std::size_t offset = 0;
    int below = 0;
    int parent = -1;  ///< supernode of the first row below; -1: none

    int columns() const { return end - first; }
    int rows() const { return columns() + below; }
  };

  /// `pairs` as in minimum_degree(), whose order is followed by a postorder of the elimination
  /// tree. Near linear in the blocks of the factor. Deterministic.
  EliminationStructure(int blocks, const std::vector<std::pair<int, int>>& pairs);

  int blocks() const { return static_cast<int>(position_.size()); }
  /// Column of the factor of a block.
  int position(int block) const { return position_[static_cast<std::size_t>(block)]; }
  const std::vector<Supernode>& supernodes() const { return supernodes_; }
  int supernode_of(int column) const { return owner_[static_cast<std::size_t>(column)]; }
  /// Columns of the factor of the rows below a supernode, ascending.
  const int* rows_below(const Supernode& of) const { return rows_.data() + of.offset; }
  /// Row of `column` in the dense matrix of `in`, of which it must be a row. O(log rows).
  int row_in(const Supernode& in, int column) const;

 private:
  std::vector<int> position_;
  std::vector<int> owner_;
  std::vector<int> rows_;
  std::vector<Supernode> supernodes_;
};

/// Computes a structure once for consecutive graphs with the same edges in the same order.
class EliminationCache {
 public:
  /// The result is valid until the next call with other arguments.
  const EliminationStructure& of(int blocks, std::vector<std::pair<int, int>> pairs) {
    if (!last_ || last_->blocks() != blocks || pairs_ != pairs) {
      last_.emplace(blocks, pairs);
      pairs_ = std::move(pairs);
    }
    return *last_;
  }

 private:
  std::optional<EliminationStructure> last_;
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace loopbench::methods
