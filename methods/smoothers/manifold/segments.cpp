#include "methods/smoothers/manifold/segments.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::methods::manifold {
namespace {

double mean_speed(const Nodes& nodes) {
  double length = 0.0;
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) length += nodes.step(edge).norm();
  return length / (nodes.stamps.back() - nodes.stamps.front());
}

/// Statistics of the speeds of the current segment.
struct Speeds {
  double slowest, fastest, last, sum;
  double count = 1.0;

  explicit Speeds(double first) : slowest(first), fastest(first), last(first), sum(first) {}

  bool admit(double speed, double band, SpeedRule rule) const {
    switch (rule) {
      case SpeedRule::adjacent:
        return std::abs(speed - last) <= band;
      case SpeedRule::bins:
        return band == 0.0 || std::floor(speed / band) == std::floor(last / band);
      case SpeedRule::running_mean:
        return std::abs(speed - sum / count) <= band;
      case SpeedRule::absolute:
        return (speed > band) == (last > band);
      default:
        return std::max(fastest, speed) - std::min(slowest, speed) <= band;
    }
  }
  void add(double speed) {
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
    last = speed;
    sum += speed;
    ++count;
  }
};

}  // namespace

std::vector<double> torsions(const Nodes& nodes) {
  std::vector<double> out(nodes.size(), 0.0);
  for (std::size_t i = 2; i + 1 < nodes.size(); ++i) {
    out[i] = angle_between_directions(nodes.step(i - 2).cross(nodes.step(i - 1)),
                                      nodes.step(i - 1).cross(nodes.step(i)));
  }
  return out;
}

std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa) {
  std::vector<double> torsion;
  if (rule.torsion_max) torsion = torsions(nodes);
  const auto bends = [&](std::size_t node) {
    return kappa[node] > rule.turn_max || (rule.torsion_max && torsion[node] > *rule.torsion_max);
  };
  const double band = rule.speed_band ? *rule.speed_band : mean_speed(nodes);
  std::vector<NodeRange> out;
  std::size_t first = 0;
  Speeds speeds(0.0);
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) {
    const double speed = nodes.step(edge).norm() / nodes.duration(edge);
    if (edge > first && speeds.admit(speed, band, rule.speed) && !bends(edge)) {
      speeds.add(speed);
      continue;
    }
    if (edge > first) out.push_back({first, edge});
    first = edge;
    speeds = Speeds(speed);
  }
  out.push_back({first, nodes.size() - 1});
  return out;
}

std::vector<NodeRange> segments(const Nodes& nodes, const SegmentRule& rule) {
  return segments(
      nodes, rule, kappas(nodes, {}, Kappa::turn_per_kf, CurveSpace::space, Vector3::UnitZ()));
}

}  // namespace loopbench::methods::manifold
