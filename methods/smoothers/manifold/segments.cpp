#include "methods/smoothers/manifold/segments.hpp"

#include <algorithm>
#include <cmath>

#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/quasi_keyframes.hpp"

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

Nodes projected(Nodes nodes, const Vector3& up) {
  for (Vector3& point : nodes.points) point -= up.dot(point) * up;
  return nodes;
}

double rotation(const Trajectory& poses, std::size_t i) {
  return 0.5 * angle_between(poses[i - 1].world_from_body.rotation,
                             poses[i + 1].world_from_body.rotation);
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
      nodes, rule, kappas(nodes, {}, Kappa::turn_per_kf, CurveSpace::space, Vector3::UnitZ()));
}

std::vector<double> kappas(const Nodes& given,
                           const Trajectory& poses,
                           Kappa definition,
                           CurveSpace plane,
                           const Vector3& up) {
  const Nodes nodes = plane == CurveSpace::plane ? projected(given, up) : given;
  std::vector<double> out(nodes.size(), 0.0);
  std::optional<NodeSpline> spline;
  if (definition == Kappa::analytic_spline) spline.emplace(nodes);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const Vector3 before = nodes.step(i - 1);
    const Vector3 after = nodes.step(i);
    const double angle = angle_between_directions(before, after);
    switch (definition) {
      case Kappa::turn_per_kf:
        out[i] = angle;
        break;
      case Kappa::menger:
        out[i] = discrete_curvature(nodes.points[i - 1], nodes.points[i], nodes.points[i + 1]);
        break;
      case Kappa::dtheta_ds: {
        const double mean_step = 0.5 * (before.norm() + after.norm());
        out[i] = mean_step > 0.0 ? angle / mean_step : 0.0;
        break;
      }
      case Kappa::dtheta_dt:
        out[i] = 2.0 * angle / (nodes.stamps[i + 1] - nodes.stamps[i - 1]);
        break;
      case Kappa::analytic_spline: {
        const MotionJet motion = spline->at(i, time_jet(nodes.stamps[i])).point;
        out[i] = curvature(motion.first, motion.second);
        break;
      }
      case Kappa::rotation_per_kf:
        out[i] = rotation(poses, i);
        break;
    }
  }
  return out;
}

std::vector<NodeRange> merge_short_segments(const Nodes& nodes,
                                            std::vector<NodeRange> runs,
                                            std::size_t min_nodes) {
  std::vector<double> path_length(nodes.size(), 0.0);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    path_length[i] = path_length[i - 1] + nodes.step(i - 1).norm();
  const auto speed = [&](const NodeRange& run) {
    return (path_length[run.last] - path_length[run.first]) /
           (nodes.stamps[run.last] - nodes.stamps[run.first]);
  };
  std::vector<NodeRange> out;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const NodeRange& run = runs[k];
    const bool has_next = k + 1 < runs.size();
    if (run.nodes() >= min_nodes || (out.empty() && !has_next)) {
      out.push_back(run);
      continue;
    }
    const bool with_next =
        out.empty() || (has_next && std::abs(speed(runs[k + 1]) - speed(run)) <
                                        std::abs(speed(out.back()) - speed(run)));
    if (with_next) {
      runs[k + 1].first = run.first;
    } else {
      out.back().last = run.last;
    }
  }
  return out;
}

FilledSegments fill_short_segments(const Trajectory& nodes,
                                   const std::vector<NodeRange>& runs,
                                   const Trajectory& frames,
                                   std::size_t min_nodes) {
  FilledSegments out;
  out.nodes.push_back(nodes.front());
  for (const NodeRange& run : runs) {
    const std::size_t first = out.nodes.size() - 1;
    const std::size_t edges = run.last - run.first;
    const std::size_t parts = run.nodes() < min_nodes ? (min_nodes - 2 + edges) / edges : 1;
    for (std::size_t i = run.first; i < run.last; ++i) {
      out.inserted += insert_frames(nodes[i], nodes[i + 1], parts, frames, out.nodes);
      out.nodes.push_back(nodes[i + 1]);
    }
    out.runs.push_back({first, out.nodes.size() - 1});
  }
  return out;
}

}  // namespace loopbench::methods::manifold
