#include "methods/find_method.hpp"

#include <algorithm>

#include "datasets/core/error.hpp"

namespace loopbench::methods {
namespace {

Trajectory result_of(const Corrector& corrector, const Problem& problem, Report& report) {
  return corrector.correct(problem, report);
}

Trajectory result_of(const Estimator& estimator, const Problem& problem, Report& report) {
  const std::unique_ptr<const Curve> curve = estimator.estimate(problem, report);
  Trajectory out = problem.keyframes;
  for (StampedPose& pose : out) pose.world_from_body = curve->at(pose.stamp);
  return out;
}

}  // namespace

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
  const auto corrected = [&](const auto& method) -> Trajectory {
    if constexpr (requires(Report report) { result_of(*method, problem, report); }) {
      const std::string why = reason_to_decline(*method, problem);
      if (!why.empty()) throw InputError(name + ": is not applicable: " + why);
      Report report;
      return result_of(*method, problem, report);
    } else {
      throw InputError(name + ": is a " + to_text(entry.kind) +
                       ", expected a corrector or a joint method");
    }
  };
  return std::visit(corrected, entry.make(options));
}

}  // namespace loopbench::methods
