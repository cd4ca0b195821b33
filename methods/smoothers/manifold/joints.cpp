#include "methods/smoothers/manifold/joints.hpp"

#include <algorithm>

namespace loopbench::manifold {

Joint joint_between(const Nodes& nodes, const Window& before, const Window& after) {
  const std::size_t node = after.owned.first;
  const double step_before = nodes.step(node - 1).norm();
  const double step_after = nodes.step(node).norm();
  const auto reach = [](double own, double next) { return next > own ? own / next : 1.0; };
  const double back = after.fitted.first < node ? 1.0 : reach(step_after, step_before);
  const double forth = before.fitted.last > node ? 1.0 : reach(step_before, step_after);
  return {nodes.stamps[node] - back * nodes.duration(node - 1),
          nodes.stamps[node] + forth * nodes.duration(node)};
}

}  // namespace loopbench::manifold
