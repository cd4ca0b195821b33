#include "harness/run/oracle_method.hpp"

#include <algorithm>

namespace loopbench::harness {

bool uses_reference(const MethodChoice& method, const Catalogue& catalogue) {
  return std::ranges::any_of(method.stages,
                             [&](const Choice& stage) { return is_oracle(catalogue, stage.name); });
}

bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference) {
  constexpr double kTolerance = 1e-9;  // of the size
  if (reference.size() < 3 || reference.size() != estimate.size()) return false;
  double size = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto& position = reference[i].world_from_body.translation;
    size = std::max(size, (position - reference.front().world_from_body.translation).norm());
    difference = std::max(difference, (estimate[i].world_from_body.translation - position).norm());
  }
  return size > 0.0 && difference <= kTolerance * size;
}

}  // namespace loopbench::harness
