#include "methods/correctors/motion_drift/motion.hpp"

#include <algorithm>

namespace loopbench::methods {
namespace {

/// For each odometry edge, whether at least one loop encloses it.
std::vector<bool> enclosed_edges(const Problem& problem) {
  std::vector<int> change(problem.odometry.size() + 1, 0);
  for (const Edge& loop : problem.closures) {
    ++change[loop.from];
    --change[loop.to];
  }
  std::vector<bool> out;
  int loops = 0;
  for (std::size_t i = 0; i < problem.odometry.size(); ++i) {
    loops += change[i];
    out.push_back(loops > 0);
  }
  return out;
}

/// Computes the part of each edge that lies within `reach` of the last enclosed edge. `edges` lists
/// the edge indices forwards or backwards along the chain; `of` returns the regressor of an edge.
template <class Edges, class Of>
void reach_along(const Edges& edges,
                 const std::vector<bool>& enclosed,
                 double reach,
                 Of of,
                 std::vector<double>& part) {
  double remaining = 0.0;
  for (const std::size_t i : edges) {
    if (enclosed[i]) {
      part[i] = 1.0;
      remaining = reach;
      continue;
    }
    const double along = of(i);
    if (remaining > 0.0) part[i] = std::max(part[i], along > remaining ? remaining / along : 1.0);
    remaining -= along;
  }
}

}  // namespace

void limit_drift(std::vector<EdgeMotion>& motions, const Problem& problem, double reach) {
  const std::vector<bool> enclosed = enclosed_edges(problem);
  std::vector<std::size_t> forwards(motions.size());
  for (std::size_t i = 0; i < forwards.size(); ++i) forwards[i] = i;
  const std::vector<std::size_t> backwards(forwards.rbegin(), forwards.rend());
  for (const Regressor regressor : kRegressors) {
    const auto along = [&](std::size_t i) { return regressor_value(regressor, motions[i]); };
    double covered = 0.0;
    for (const std::size_t i : forwards) covered += enclosed[i] ? along(i) : 0.0;
    std::vector<double> part(motions.size(), 0.0);
    reach_along(forwards, enclosed, reach * covered, along, part);
    reach_along(backwards, enclosed, reach * covered, along, part);
    for (const std::size_t i : forwards) {
      motions[i].drift_part[static_cast<std::size_t>(regressor)] = part[i];
    }
  }
}

}  // namespace loopbench::methods
