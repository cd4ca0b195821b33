#include "methods/find_method.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

namespace loopbench::methods {

MethodEntry find_method(const std::string& name) {
  const std::vector<MethodEntry> all = methods();
  const auto found = std::ranges::find(all, name, &MethodEntry::name);
  if (found != all.end()) return *found;
  std::string known;
  for (const MethodEntry& entry : all) known += (known.empty() ? "" : ", ") + entry.name;
  throw InputError("no method is named '" + name + "', expected one of " + known);
}

Trajectory correct(const Problem& problem, const std::string& name, const Params& options) {
  const MethodEntry entry = find_method(name);
  const Stage stage = entry.make(options);
  const auto* corrector = std::get_if<std::unique_ptr<const Corrector>>(&stage);
  if (corrector == nullptr) {
    throw InputError(name + ": is a " + to_text(entry.kind) + ", expected a corrector");
  }
  const std::string why = reason_to_decline(**corrector, problem);
  if (!why.empty()) throw InputError(name + ": is not applicable: " + why);
  Report report;
  return (*corrector)->correct(problem, report);
}

}  // namespace loopbench::methods
