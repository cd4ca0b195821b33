/// Elimination structure that is used again for the same edges.
#pragma once

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

}  // namespace loopbench::methods
