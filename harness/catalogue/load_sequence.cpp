#include "harness/catalogue/load_sequence.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>

#include "datasets/core/error.hpp"
#include "harness/base/printable.hpp"
#include "harness/catalogue/floating_point_guard.hpp"
#include "harness/catalogue/oracle_closures.hpp"

namespace loopbench::harness {
namespace {

/// `seed`, and seeds of components (`false_closures.seed`).
bool is_seed(const OptionInfo& option) {
  return option.name == "seed" || option.name.ends_with(".seed");
}

Params all_options(const DatasetChoice& choice, const DatasetEntry& entry) {
  Params out;
  for (const OptionInfo& option : entry.options) out.emplace(option.name, option.value);
  for (const auto& [name, value] : choice.dataset.options) out.insert_or_assign(name, value);
  return out;
}

/// Whether another seed changes the data; a component's seed does so only if the component is
/// enabled.
bool decides(const OptionInfo& seed, const Params& options) {
  if (!is_seed(seed)) return false;
  const auto share = options.find(seed.name.substr(0, seed.name.rfind("seed")) + "share");
  if (share == options.end()) return true;
  return share->second != Param{0.0} && share->second != Param{std::int64_t{0}};
}

/// What a dataset does to the floating-point mode must not change the results of methods. Replaces
/// messages of exceptions that are empty or too long to print; others keep their type.
Sequence loaded(const DatasetEntry& entry,
                const Params& options,
                const DataRoot& root,
                const std::string& label) {
  constexpr std::size_t kLongestMessage = 10'000;  // [bytes]
  const FloatingPointGuard guard;
  try {
    return entry.load(options, root);
  } catch (const std::exception& error) {
    const std::string_view text = error.what() != nullptr ? error.what() : "";
    if (!text.empty() && text.size() <= kLongestMessage) throw;
    if (text.empty()) throw InputError(label + ": loading threw an exception without a message");
    throw InputError(limited(text, kLongestMessage));
  }
}

}  // namespace

std::vector<bool> seeded(const Sweep& sweep, const Catalogue& catalogue) {
  std::vector<bool> out;
  for (const DatasetChoice& choice : sweep.datasets) {
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    const Params options = all_options(choice, entry);
    out.push_back(std::ranges::any_of(
        entry.options, [&](const OptionInfo& option) { return decides(option, options); }));
  }
  return out;
}

Params full_options(const DatasetChoice& choice, const DatasetEntry& entry, int repeat) {
  Params out = all_options(choice, entry);
  for (const OptionInfo& option : entry.options) {
    if (!is_seed(option)) continue;
    out[option.name] = derived_seed(std::get<std::int64_t>(out.at(option.name)), repeat);
  }
  return out;
}

namespace {

Sequence load_one(const Cell& cell,
                  const Sweep& sweep,
                  const Catalogue& catalogue,
                  const DataRoot& root) {
  const DatasetChoice& choice = sweep.datasets[cell.dataset];
  const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
  Params options = choice.dataset.options;
  const Params full = full_options(choice, entry, cell.repeat);
  for (const OptionInfo& option : entry.options) {
    if (is_seed(option)) options[option.name] = full.at(option.name);
  }
  Sequence sequence = loaded(entry, options, root, choice.label);
  check(sequence.problem, choice.label);
  check(sequence.reference, choice.label + ": reference", Rotations::optional);
  return sequence;
}

}  // namespace

std::vector<std::size_t> related_datasets(const Sweep& sweep, std::size_t dataset) {
  std::vector<std::size_t> out;
  const std::string& odometer = sweep.datasets[dataset].odometer;
  for (std::size_t i = 0; i < sweep.datasets.size() && !odometer.empty(); ++i) {
    if (i != dataset && sweep.datasets[i].odometer == odometer) out.push_back(i);
  }
  return out;
}

Sequence load_sequence(const Cell& cell,
                       const Sweep& sweep,
                       const Catalogue& catalogue,
                       const DataRoot& root) {
  Sequence out = load_one(cell, sweep, catalogue, root);
  const auto reads_same_file = [&](const Sequence& other) {
    return std::ranges::any_of(other.provenance.inputs, [&](const InputPath& input) {
      return std::ranges::count(out.provenance.inputs, input.path, &InputPath::path) > 0;
    });
  };
  std::vector<InputPath> inputs;
  std::vector<Problem> related;
  for (const std::size_t other : related_datasets(sweep, cell.dataset)) {
    Cell one = cell;
    one.dataset = other;
    Sequence sequence = load_one(one, sweep, catalogue, root);
    for (const InputPath& input : sequence.provenance.inputs) {
      inputs.push_back({input.path, sweep.datasets[other].label + ": " + input.option});
    }
    if (reads_same_file(sequence)) continue;  // the same drive with other options
    out.provenance.oracle_closures |=
        sequence.provenance.oracle_closures || undeclared_oracle_closures(sequence) > 0;
    sequence.problem.frames.clear();
    related.push_back(std::move(sequence.problem));
  }
  std::ranges::move(inputs, std::back_inserter(out.provenance.inputs));
  if (!related.empty()) {
    out.problem.related = std::make_shared<const std::vector<Problem>>(std::move(related));
  }
  return out;
}

}  // namespace loopbench::harness
