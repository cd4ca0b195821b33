#include "methods/smoothers/manifold/joints.hpp"

#include <algorithm>

namespace loopbench::methods::manifold {

JointKind JointRule::at(const Nodes& nodes, std::size_t node) const {
  if (!c0_below) return kind;
  const double length = nodes.step(node - 1).norm() + nodes.step(node).norm();
  const double duration = nodes.stamps[node + 1] - nodes.stamps[node - 1];
  return length / duration < *c0_below ? JointKind::c0 : kind;
}

Joint joint_between(const Nodes& nodes, const Window& before, const Window& after) {
  const std::size_t node = after.owned.first;
  const double step_before = nodes.step(node - 1).norm();
  const double step_after = nodes.step(node).norm();
  const auto extension = [](double own_step, double next_step) {
    return next_step > own_step ? own_step / next_step : 1.0;
  };
  const double extension_back =
      after.fitted.first < node ? 1.0 : extension(step_after, step_before);
  const double extension_forward =
      before.fitted.last > node ? 1.0 : extension(step_before, step_after);
  return {nodes.stamps[node] - extension_back * nodes.duration(node - 1),
          nodes.stamps[node] + extension_forward * nodes.duration(node)};
}

Joint sliding_joint(const Nodes& nodes,
                    const Window& before,
                    const Window& after,
                    std::size_t size) {
  const std::size_t node = after.owned.first;
  const bool has_line = before.fitted.nodes() == 2 || after.fitted.nodes() == 2;
  if (size % 2 == 1 && !has_line) return {nodes.stamps[node - 1], nodes.stamps[node]};
  return {nodes.stamps[node] - 0.5 * nodes.duration(node - 1),
          nodes.stamps[node] + 0.5 * nodes.duration(node)};
}

}  // namespace loopbench::methods::manifold
