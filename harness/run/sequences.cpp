#include "harness/run/sequences.hpp"

#include <algorithm>

namespace loopbench {
namespace {

/// `seed`, and those of a part (`false_closures.seed`).
bool is_seed(const OptionInfo& option) {
  return option.name == "seed" || option.name.ends_with(".seed");
}

}  // namespace

std::vector<bool> seeded(const Sweep& sweep, const Catalogue& catalogue) {
  std::vector<bool> out;
  for (const DatasetChoice& choice : sweep.datasets) {
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    out.push_back(std::ranges::any_of(entry.options, is_seed));
  }
  return out;
}

Sequences::Sequences(const Sweep& sweep,
                     const Catalogue& catalogue,
                     DataRoot root,
                     const std::vector<Cell>& cells)
    : sweep_(sweep), catalogue_(catalogue), root_(std::move(root)) {
  for (const Cell& cell : cells) ++slots_[{cell.dataset, cell.repeat}].waiting;
}

std::shared_ptr<const Sequence> Sequences::get(const Cell& cell) {
  Slot& slot = slots_.at({cell.dataset, cell.repeat});
  const std::lock_guard lock(slot.mutex);
  if (!slot.sequence) slot.sequence = load(cell);
  return slot.sequence;
}

void Sequences::done(const Cell& cell) {
  Slot& slot = slots_.at({cell.dataset, cell.repeat});
  const std::lock_guard lock(slot.mutex);
  if (--slot.waiting == 0) slot.sequence.reset();
}

std::shared_ptr<const Sequence> Sequences::load(const Cell& cell) const {
  const DatasetChoice& choice = sweep_.datasets[cell.dataset];
  const DatasetEntry& entry = find_dataset(catalogue_, choice.dataset.name);
  Params options = choice.dataset.options;
  for (const OptionInfo& option : entry.options) {
    if (!is_seed(option)) continue;
    const Param base = options.contains(option.name) ? options.at(option.name) : option.value;
    options[option.name] = derived_seed(std::get<std::int64_t>(base), cell.repeat);
  }
  auto sequence = std::make_shared<Sequence>(entry.load(options, root_));
  check(sequence->problem, choice.label);
  check(sequence->reference, choice.label + ": reference");
  return sequence;
}

}  // namespace loopbench
