/// Assignment of cells to workers; a worker prefers cells of its loaded sequence.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "harness/sweep/model/cells.hpp"

namespace loopbench::harness {

class CellQueue {
 public:
  explicit CellQueue(const std::vector<Cell>& cells) {
    std::map<std::pair<std::size_t, int>, std::size_t> known;
    std::vector<std::size_t> datasets;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Cell& cell = cells[i];
      const auto [entry, fresh] = known.try_emplace({cell.dataset, cell.repeat}, groups_.size());
      if (fresh) groups_.emplace_back();
      groups_[entry->second].push_back(i);
      group_of_.push_back(entry->second);
      if (datasets.empty() || datasets.back() != cell.dataset) {
        datasets.push_back(cell.dataset);
        first_of_datasets_.push_back(i);
      }
    }
    for (const auto& group : groups_) unfinished_.push_back(group.size());
    started_.assign(groups_.size(), false);
  }

  /// Index of the next cell: of `group` (the worker's previous one) if it has cells left, otherwise
  /// of a sequence that has not been started, otherwise of the one with the most cells left.
  /// `group` becomes its group. nullopt if all cells are assigned. O(workers) except for returned
  /// cells.
  std::optional<std::size_t> next(std::optional<std::size_t>& group) {
    const auto take = [&](std::size_t from) {
      if (!started_[from]) open_.push_back(from);
      started_[from] = true;
      group = from;
      const std::size_t index = groups_[from].front();
      groups_[from].pop_front();
      return index;
    };
    if (group && !groups_[*group].empty()) return take(*group);
    while (first_unstarted_ < groups_.size() && started_[first_unstarted_]) ++first_unstarted_;
    if (first_unstarted_ < groups_.size()) return take(first_unstarted_);
    std::erase_if(open_, [&](std::size_t g) { return groups_[g].empty(); });
    if (open_.empty()) return std::nullopt;
    return take(
        *std::ranges::max_element(open_, {}, [&](std::size_t g) { return groups_[g].size(); }));
  }

  /// Returns a cell whose worker ended before starting it.
  void requeue(std::size_t index) {
    const std::size_t group = group_of_[index];
    groups_[group].push_front(index);
    if (started_[group] && std::ranges::count(open_, group) == 0) open_.push_back(group);
  }

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
