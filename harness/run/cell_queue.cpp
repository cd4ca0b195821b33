#include "harness/run/cell_queue.hpp"

#include <algorithm>

namespace loopbench::harness {

CellQueue::CellQueue(const std::vector<Cell>& cells) {
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

std::optional<std::size_t> CellQueue::next(std::optional<std::size_t>& group) {
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

void CellQueue::requeue(std::size_t index) {
  const std::size_t group = group_of_[index];
  groups_[group].push_front(index);
  if (started_[group] && std::ranges::count(open_, group) == 0) open_.push_back(group);
}

}  // namespace loopbench::harness
