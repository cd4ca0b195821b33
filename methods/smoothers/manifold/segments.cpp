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
  double slowest, fastest, last;

  explicit Speeds(double first) : slowest(first), fastest(first), last(first) {}

  bool admit(double speed, double band, SpeedRule rule) const {
    if (rule == SpeedRule::adjacent) return std::abs(speed - last) <= band;
    return std::max(fastest, speed) - std::min(slowest, speed) <= band;
  }
  void add(double speed) {
    slowest = std::min(slowest, speed);
    fastest = std::max(fastest, speed);
    last = speed;
  }
};

Nodes projected(Nodes nodes, const Vector3& up) {
  for (Vector3& point : nodes.points) point -= up.dot(point) * up;
  return nodes;
}

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
      nodes, rule, kappas(nodes, Kappa::turn_per_kf, CurveSpace::space, Vector3::UnitZ()));
}

std::vector<double> kappas(const Nodes& given,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up) {
  const Nodes nodes = plane == CurveSpace::plane ? projected(given, up) : given;
  std::vector<double> out(nodes.size(), 0.0);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const double angle = angle_between_directions(nodes.step(i - 1), nodes.step(i));
    switch (definition) {
      case Kappa::turn_per_kf:
        out[i] = angle;
        break;
      case Kappa::menger:
        out[i] = discrete_curvature(nodes.points[i - 1], nodes.points[i], nodes.points[i + 1]);
        break;
      case Kappa::dtheta_dt:
        out[i] = 2.0 * angle / (nodes.stamps[i + 1] - nodes.stamps[i - 1]);
        break;
    }
  }
  return out;
}

}  // namespace loopbench::methods::manifold
