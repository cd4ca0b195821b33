/// Assignment of cells to workers; a worker prefers cells of its loaded sequence.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "harness/model/cells.hpp"

namespace loopbench::harness {

class CellQueue {
 public:
  explicit CellQueue(const std::vector<Cell>& cells);

  /// Index of the next cell: of `group` (the worker's previous one) if it has cells left, otherwise
  /// of a sequence that has not been started, otherwise of the one with the most cells left.
  /// `group` becomes its group. nullopt if all cells are assigned. O(workers) except for returned
  /// cells.
  std::optional<std::size_t> next(std::optional<std::size_t>& group);

  /// Returns a cell whose worker ended before starting it.
  void requeue(std::size_t index);

  /// Marks a cell as done; returns whether it was the last of its group.
  bool finish(std::size_t index) { return --unfinished_[group_of_[index]] == 0; }

  /// The first cell of each dataset, to load before anything runs.
  const std::vector<std::size_t>& first_of_datasets() const { return first_of_datasets_; }

  std::size_t group_of(std::size_t index) const { return group_of_[index]; }

 private:
  std::vector<std::deque<std::size_t>> groups_;  ///< remaining cells by sequence
  std::vector<std::size_t> group_of_;            ///< by cell
  std::vector<std::size_t> first_of_datasets_;
  std::vector<std::size_t> unfinished_;  ///< by group
  std::vector<bool> started_;            ///< by group
  std::size_t first_unstarted_ = 0;      ///< all groups before this one are started
  std::vector<std::size_t> open_;        ///< started groups that can have cells left
};

}  // namespace loopbench::harness
