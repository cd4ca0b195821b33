#include "harness/provenance/oracle_closures.hpp"

#include "datasets/derive/poses_at.hpp"
#include "metrics/trajectory/position_only.hpp"

namespace loopbench::harness {
namespace {

constexpr double kDistance = 1e-4;  // [m]; rounding of trajectory files is at most this
constexpr double kAngle = 1e-4;     // [rad]

}  // namespace

std::size_t closures_equal_to_reference(const Sequence& sequence) {
  const Problem& problem = sequence.problem;
  const bool measured = sequence.provenance.noise.empty();
  if (!measured || sequence.reference.empty() || problem.closures.empty()) return 0;
  if (metrics::is_position_only(sequence.reference)) return 0;
  const auto truth = poses_at(sequence.reference, stamps(problem.keyframes), {});
  std::size_t equal = 0;
  for (const Edge& closure : problem.closures) {
    if (!truth[closure.from] || !truth[closure.to]) continue;
    if (is_close(closure.from_from_to, Pose{}, kDistance, kAngle)) continue;
    const Pose from_from_to = truth[closure.from]->inverse() * *truth[closure.to];
    if (is_close(closure.from_from_to, from_from_to, kDistance, kAngle)) ++equal;
  }
  return equal;
}

bool are_oracle_closures(std::size_t equal, std::size_t all) {
  constexpr std::size_t kOneIn = 20;  // at most 95 % of all closures are false
  return equal > 0 && kOneIn * equal >= all;
}

}  // namespace loopbench::harness
