/// Cholesky factor of normal equations over poses, of which parts are computed again.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

namespace loopbench::methods {

/// Normal equations of one edge: the matrix over both poses, and the right-hand side as its last
/// column.
template <int D>
struct EdgeEquations {
  std::size_t from = 0;
  std::size_t to = 0;
  Eigen::Matrix<double, 2 * D, 2 * D + 1> matrix;  ///< order [from, to]
};

/// Poses of D dimensions each; pose 0 is fixed. Each pose keeps its rows of the factor and the
/// Schur complement that its elimination leaves on its separator (the later poses that it is
/// connected to). Its parent is the first pose of the separator, and the separators along a path to
/// the root contain each other's remainders. So if edges change, only the poses at their ends and
/// all ancestors of these are eliminated again. Implemented for D = 3, 6. See
/// incremental_smoother.hpp.
template <int D>
class EliminationTree {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  struct Graph {
    std::vector<std::vector<std::size_t>> edges_of;  ///< edges at each pose, by index
    std::vector<EdgeEquations<D>> equations;         ///< of each edge, at its linearisation
  };

  void add_pose();

  /// Eliminates `touched` and their ancestors again, and computes the corrections that this
  /// changes. `touched` contains both ends of every edge whose equations have changed. They are
  /// ordered anew if there are new edges or poses since the last update. Returns the poses with a
  /// new correction. Throws std::runtime_error if a block is not positive definite.
  std::vector<std::size_t> update(const std::vector<std::size_t>& touched,
                                  const Graph& graph,
                                  bool has_new_edges);

  /// Solution of the equations for one pose.
  const Vector& correction(std::size_t pose) const { return nodes_[pose].correction; }

  /// Decrease of the quadratic cost from the points of linearisation to the solution, in the poses
  /// that the last update eliminated.
  double decrease() const { return decrease_; }

  /// Number of eliminations so far.
  std::size_t eliminations() const { return eliminations_; }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Node {
    Vector correction = Vector::Zero();
    std::size_t rank = 0;  ///< time of the elimination; 0: none yet
    std::size_t parent = kNone;
    std::vector<std::size_t> separator;
    std::vector<std::size_t> children;
    /// Own triangle, separator, right-hand side: D x ((1 + k) D + 1).
    Eigen::Matrix<double, D, Eigen::Dynamic> rows;
    /// Upper triangle of blocks on the separator, and right-hand side: k D x (k D + 1).
    Eigen::MatrixXd schur;
  };

  /// Marks these poses and their ancestors. Returns them, each before its parent.
  std::vector<std::size_t> affected_by(const std::vector<std::size_t>& touched);
  /// The marked poses in a new order.
  std::vector<std::size_t> ordered(const Graph& graph) const;
  void attach_to_parent(std::size_t pose);
  void eliminate(std::size_t pose, const Graph& graph);
  template <class Equations, class Poses>
  void add_equations(Node& node, const Equations& equations, const Poses& poses) const;
  bool solve(std::size_t pose);

  std::vector<Node> nodes_;
  std::vector<char> is_marked_;     ///< affected, then: correction changed
  std::vector<Eigen::Index> slot_;  ///< of a pose in the rows of the current one, or -1
  std::size_t next_rank_ = 1;
  std::size_t eliminations_ = 0;
  double decrease_ = 0.0;
};

}  // namespace loopbench::methods
