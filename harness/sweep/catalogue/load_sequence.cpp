#include "harness/sweep/catalogue/load_sequence.hpp"

#include <algorithm>
#include <string_view>

#include "datasets/core/error.hpp"
#include "harness/sweep/catalogue/floating_point_guard.hpp"
#include "harness/sweep/text/printable.hpp"

namespace loopbench::harness {
namespace {

/// `seed`, and seeds of components (`false_closures.seed`).
bool is_seed(const OptionInfo& option) {
  return option.name == "seed" || option.name.ends_with(".seed");
}

/// Whether another seed changes the data; a component's seed does so only if the component is
/// enabled.
bool decides(const OptionInfo& seed, const Params& options) {
  if (!is_seed(seed)) return false;
  const auto share = options.find(seed.name.substr(0, seed.name.rfind("seed")) + "share");
  if (share == options.end()) return true;
  return share->second != Param{0.0};
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

Params in_full(const std::vector<OptionInfo>& options, const Params& given) {
  Params out;
  for (const OptionInfo& option : options) out.emplace(option.name, option.value);
  for (const auto& [name, value] : given) {
    const auto found = out.find(name);
    const auto* integer = std::get_if<std::int64_t>(&value);
    const bool real = found != out.end() && std::holds_alternative<double>(found->second);
    out[name] = real && integer != nullptr ? Param(static_cast<double>(*integer)) : value;
  }
  return out;
}

std::vector<bool> seeded(const Sweep& sweep, const Catalogue& catalogue) {
  std::vector<bool> out;
  for (const DatasetChoice& choice : sweep.datasets) {
    const DatasetEntry& entry = find_dataset(catalogue, choice.dataset.name);
    const Params options = in_full(entry.options, choice.dataset.options);
    out.push_back(std::ranges::any_of(
        entry.options, [&](const OptionInfo& option) { return decides(option, options); }));
  }
  return out;
}

Params full_options(const DatasetChoice& choice, const DatasetEntry& entry, int repeat) {
  Params out = in_full(entry.options, choice.dataset.options);
  for (const OptionInfo& option : entry.options) {
    if (!is_seed(option)) continue;
    out[option.name] = derived_seed(std::get<std::int64_t>(out.at(option.name)), repeat);
  }
  return out;
}

Sequence load_sequence(const Cell& cell,
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

}  // namespace loopbench::harness
