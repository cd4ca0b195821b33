#include "harness/catalogue/oracle_closures.hpp"

#include "datasets/derive/poses_at.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {

std::size_t undeclared_oracle_closures(const Sequence& sequence) {
  constexpr std::size_t kOneIn = 20;  // at most 95 % of all closures are false
  const Problem& problem = sequence.problem;
  const bool measured = sequence.provenance.noise.empty();
  if (!measured || sequence.reference.empty() || problem.closures.empty()) return 0;
  if (metrics::is_position_only(sequence.reference)) return 0;
  const auto truth = poses_at(sequence.reference, stamps(problem.keyframes), {});
  std::size_t equal = 0;
  for (const Edge& closure : problem.closures) {
    if (!truth[closure.from] || !truth[closure.to]) continue;
    if (is_close(closure.from_from_to, Pose{}, kCopyDistance, kCopyAngle)) continue;
    const Pose from_from_to = truth[closure.from]->inverse() * *truth[closure.to];
    if (is_close(closure.from_from_to, from_from_to, kCopyDistance, kCopyAngle)) ++equal;
  }
  return kOneIn * equal >= problem.closures.size() ? equal : 0;
}

}  // namespace loopbench::harness
