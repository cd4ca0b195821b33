/// Cholesky factor of normal equations over poses, of which parts are computed again.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace loopbench::methods {

/// Normal equations of one edge: the matrix over both poses, and the right-hand side as its last
/// column.
struct EdgeEquations {
  std::size_t from = 0;
  std::size_t to = 0;
  Eigen::MatrixXd matrix;  ///< 2 d x (2 d + 1), order [from, to]
};

/// Poses of `d` dimensions each; pose 0 is fixed. Each pose keeps its rows of the factor and the
/// Schur complement that its elimination leaves on its separator (the later poses that it is
/// connected to). Its parent is the first pose of the separator, and the separators along a path to
/// the root contain each other's remainders. So if edges change, only the poses at their ends and
/// all ancestors of these are eliminated again. See incremental_smoother.hpp.
class EliminationTree {
 public:
  explicit EliminationTree(Eigen::Index d) : d_(d) {}

  void add_pose();

  /// Edges at a pose, by index, and the equations of an edge at the current linearisation.
  struct Graph {
    std::function<const std::vector<std::size_t>&(std::size_t pose)> edges_of;
    std::function<const EdgeEquations&(std::size_t edge)> equations;
  };

  /// Eliminates `touched` and their ancestors again, and computes the corrections that this
  /// changes. `touched` contains both ends of every edge whose equations have changed. Returns the
  /// poses with a new correction. Throws std::runtime_error if a block is not positive definite.
  std::vector<std::size_t> update(const std::vector<std::size_t>& touched, const Graph& graph);

  /// Solution of the equations for one pose, d numbers.
  const Eigen::VectorXd& correction(std::size_t pose) const { return nodes_[pose].correction; }

  /// Number of eliminations so far.
  std::size_t eliminations() const { return eliminations_; }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Node {
    Eigen::VectorXd correction;
    std::size_t rank = 0;  ///< time of the elimination; 0: none yet
    std::size_t parent = kNone;
    std::vector<std::size_t> separator;
    std::vector<std::size_t> children;
    Eigen::MatrixXd rows;   ///< own triangle, separator, right-hand side: d x ((1 + k) d + 1)
    Eigen::MatrixXd schur;  ///< on the separator, with right-hand side: k d x (k d + 1)
  };

  std::vector<std::size_t> affected_by(const std::vector<std::size_t>& touched);
  std::vector<std::size_t> ordered(const std::vector<std::size_t>& affected, const Graph& graph);
  void attach_to_parent(std::size_t pose);
  void eliminate(std::size_t pose, const Graph& graph);
  void add_block(Eigen::MatrixXd& front,
                 const Eigen::MatrixXd& block,
                 const std::vector<std::size_t>& poses) const;
  bool solve(std::size_t pose);

  Eigen::Index d_;
  std::vector<Node> nodes_;
  std::vector<char> is_marked_;     ///< affected, then: correction changed
  std::vector<Eigen::Index> slot_;  ///< of a pose in the current front, or -1
  std::size_t next_rank_ = 1;
  std::size_t eliminations_ = 0;
};

}  // namespace loopbench::methods
