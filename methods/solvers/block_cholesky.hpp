/// Cholesky factorisation of a sparse symmetric matrix of D x D blocks.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "methods/solvers/elimination_structure.hpp"

namespace loopbench::methods {

/// Multifrontal factorisation: the panel of a supernode is assembled from the matrix and from the
/// updates of its children in the elimination tree, and its own update goes to its parent. The
/// matrix is assembled directly into the panels of the factor, so that nothing is allocated after
/// construction. A panel is cleared when it is first added to, and the forward substitution visits
/// it when it is eliminated: on long chains the time goes into memory traffic. Implemented for D =
/// 1, 2, 3, 4, 6, 7. Deterministic, one thread. Source: Liu, The multifrontal method for sparse
/// matrix solution: theory and practice, SIAM Review 34(1), 1992.
template <int D>
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, D, D>;
  /// Storage of the block in row i and column j or, if that is in the upper triangle, of its
  /// transpose.
  struct Location {
    std::size_t offset = 0;
    int stride = 0;
    int supernode = 0;
    bool is_transposed = false;
  };

  /// `structure` must outlive this object.
  explicit BlockCholesky(const EliminationStructure& structure);

  /// The pair (i, j) is on the diagonal or in the pairs of the structure.
  Location location(int i, int j) const;
  void set_zero() { ++matrix_; }
  void add(const Location& at, const Block& block);

  /// Replaces the matrix by its factor; false: it is not positive definite to rounding.
  bool factorise();

  /// Replaces the columns of `right`, with D rows per block, by the solutions.
  void solve(Eigen::MatrixXd& right);

  /// Replaces the factor by the inverse of the matrix, where the factor has blocks: each depends
  /// only on later columns there. Time of factorise(), up to a constant. Source: A. M. Erisman, W.
  /// F. Tinney, On computing certain elements of the inverse of a sparse matrix, CACM 18(3), 1975.
  /// Implemented for D = 3 and 6, as inverse_block().
  void invert();

  /// Block of the inverse after invert().
  Block inverse_block(const Location& at) const;

  /// factorise() with the diagonal multiplied by 1 + `damping`, and solve() of one column.
  /// `diagonal`: its values before, in the order of elimination.
  bool solve_damped(double damping, Eigen::VectorXd& diagonal, Eigen::VectorXd& right);

 private:
  using Supernode = EliminationStructure::Supernode;

  /// Calls `before` and `after` with the index of each supernode, before and after its elimination.
  template <class Before, class After>
  bool eliminate(Before before, After after);
  std::size_t count() const { return cleared_for_.size(); }
  static std::size_t update_size(const Supernode& of) {
    return static_cast<std::size_t>(of.below * D) * static_cast<std::size_t>(of.below * D);
  }
  std::size_t top() const { return waiting_.empty() ? 0 : waiting_.back().end; }
  /// Index of the first child of the supernode in waiting_; its children are the last ones there.
  std::size_t first_child(std::size_t supernode) const;
  /// Takes the updates of the children off the stack; returns where that of the supernode begins.
  std::size_t replace_children(std::size_t supernode);
  void clear(std::size_t supernode);
  void prefetch(std::size_t supernode) const;
  /// One column of `right` goes to ordered_, in the order of elimination, and back.
  void order(const double* right);
  void forward(std::size_t supernode);
  void backward(double* right);
  void add_update(const double* from, std::size_t child, double* panel, double* update);
  void gather_inverse(const Supernode& of, Eigen::MatrixXd& lower) const;

  const EliminationStructure& structure_;
  std::vector<std::size_t> panel_;  ///< offset of the panel of each supernode in values_, and end
  Eigen::VectorXd values_;          ///< panels, column-major, rows() D x columns() D
  std::vector<int> cleared_for_;    ///< matrix of each panel
  int matrix_ = 0;                  ///< number of calls of set_zero()
  std::vector<int> row_in_parent_;  ///< of each row below of each supernode
  /// Update that waits for the parent of its supernode, in stack_.
  struct Waiting {
    std::size_t supernode, begin, end;
  };
  std::vector<Waiting> waiting_;
  std::vector<double> stack_;  ///< lower triangles
  Eigen::VectorXd ordered_;
  Eigen::VectorXd gathered_;
};

}  // namespace loopbench::methods
