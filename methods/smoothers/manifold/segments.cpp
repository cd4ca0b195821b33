#include "methods/smoothers/manifold/segments.hpp"

#include <algorithm>

namespace loopbench::manifold {
namespace {

double mean_speed(const Nodes& nodes) {
  double length = 0.0;
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) length += nodes.step(edge).norm();
  return length / (nodes.stamps.back() - nodes.stamps.front());
}

}  // namespace

std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule) {
  const double band = rule.speed_band ? *rule.speed_band : mean_speed(nodes);
  std::vector<NodeRange> out;
  std::size_t first = 0;
  double slowest = 0.0;
  double fastest = 0.0;
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) {
    const double speed = nodes.step(edge).norm() / nodes.duration(edge);
    if (edge > first) {
      const double range = std::max(fastest, speed) - std::min(slowest, speed);
      if (range > band || turn_between(nodes.step(edge - 1), nodes.step(edge)) > rule.turn_max) {
        out.push_back({first, edge});
        first = edge;
      }
    }
    slowest = edge == first ? speed : std::min(slowest, speed);
    fastest = edge == first ? speed : std::max(fastest, speed);
  }
  out.push_back({first, nodes.size() - 1});
  return out;
}

}  // namespace loopbench::manifold
