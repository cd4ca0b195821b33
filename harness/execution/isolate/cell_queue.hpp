/// Which cell a worker does next: those of one sequence together, since loading it costs.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "harness/model/cells.hpp"

namespace loopbench {

class CellQueue {
 public:
  explicit CellQueue(const std::vector<Cell>& cells);

  /// Index of a cell: of `group` (the worker's last one) if any is left there, else of a sequence
  /// that nobody has begun, else of the one with the most cells left. `group` becomes its group.
  /// Nothing when all are given out. O(workers) but for cells given back.
  std::optional<std::size_t> next(std::optional<std::size_t>& group);

  /// A cell whose worker ended before it began.
  void give_back(std::size_t index);

  /// Says that a cell is done; whether it was the last of its group.
  bool finish(std::size_t index) { return --unfinished_[group_of_[index]] == 0; }

  /// The first cell of each dataset, to load before anything runs.
  const std::vector<std::size_t>& first_of_datasets() const { return first_of_datasets_; }

  std::size_t group_of(std::size_t index) const { return group_of_[index]; }

 private:
  std::vector<std::deque<std::size_t>> groups_;  ///< cells left, by sequence
  std::vector<std::size_t> group_of_;            ///< by cell
  std::vector<std::size_t> first_of_datasets_;
  std::vector<std::size_t> unfinished_;  ///< by group
  std::vector<bool> begun_;              ///< by group
  std::size_t untouched_ = 0;            ///< groups before it are begun
  std::vector<std::size_t> open_;        ///< begun groups that may have cells left
};

}  // namespace loopbench
