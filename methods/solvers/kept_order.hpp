/// Elimination orders that are used again.
#pragma once

#include <Eigen/Core>
#include <any>
#include <memory>
#include <utility>
#include <vector>

#include "methods/solvers/elimination_structure.hpp"

namespace loopbench::methods {

/// Computes a structure once for graphs of the same edges, in the same order.
class SharedStructure {
 public:
  std::shared_ptr<const EliminationStructure> of(int blocks,
                                                 std::vector<std::pair<int, int>> pairs) {
    if (!last_ || last_->blocks() != blocks || pairs_ != pairs) {
      last_ = std::make_shared<const EliminationStructure>(blocks, pairs);
      pairs_ = std::move(pairs);
    }
    return last_;
  }

 private:
  std::shared_ptr<const EliminationStructure> last_;
  std::vector<std::pair<int, int>> pairs_;
};

/// For a graph that grows. New blocks are eliminated after all earlier ones, until a factorisation
/// takes more than `limit` times the work per block that it took under a new order; then the order
/// is computed again.
class KeptOrder {
 public:
  explicit KeptOrder(double limit) : limit_(limit) {}

  /// Structure of a graph of at least as many blocks as in the call before. Complexity as that of
  /// EliminationStructure.
  EliminationStructure structure(int blocks, const std::vector<std::pair<int, int>>& pairs) {
    while (static_cast<int>(position_.size()) < blocks) {
      position_.push_back(static_cast<int>(position_.size()));
    }
    if (computed_ > 0) {
      EliminationStructure kept(position_, pairs);
      if (kept.work() <= limit_ * work_per_block_ * blocks) return kept;
    }
    EliminationStructure out(blocks, pairs);
    position_ = out.positions();
    work_per_block_ = out.work() / blocks;
    ++computed_;
    return out;
  }

  /// Of the factor before (BlockCholesky): a new one costs page faults on long paths.
  Eigen::VectorXd storage;

  /// Whitened odometry of the solve before (NormalEquations). Reset it if known edges change.
  std::any odometry;

  /// Number of orders computed so far.
  int computed() const { return computed_; }

 private:
  double limit_;
  std::vector<int> position_;
  double work_per_block_ = 0.0;
  int computed_ = 0;
};

}  // namespace loopbench::methods
