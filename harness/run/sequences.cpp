#include "harness/run/sequences.hpp"

#include <algorithm>

namespace loopbench {
namespace {

const OptionInfo* seed_option(const DatasetEntry& entry) {
  const auto found = std::ranges::find(entry.options, "seed", &OptionInfo::name);
  return found == entry.options.end() ? nullptr : &*found;
}

}  // namespace

std::vector<bool> seeded(const Sweep& sweep, const Catalogue& catalogue) {
  std::vector<bool> out;
  for (const DatasetChoice& choice : sweep.datasets) {
    out.push_back(seed_option(find_dataset(catalogue, choice.dataset.name)) != nullptr);
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
  if (const OptionInfo* seed = seed_option(entry)) {
    const Param base = options.contains("seed") ? options.at("seed") : seed->value;
    options["seed"] = derived_seed(std::get<std::int64_t>(base), cell.repeat);
  }
  auto sequence = std::make_shared<Sequence>(entry.load(options, root_));
  if (root_.note) {
    for (const std::string& note : sequence->provenance.notes) {
      root_.note(choice.label + ": " + note);
    }
  }
  check(sequence->problem, choice.label);
  check(sequence->reference, choice.label + ": reference");
  return sequence;
}

}  // namespace loopbench
