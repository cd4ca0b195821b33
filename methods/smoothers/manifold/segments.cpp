#include "methods/smoothers/manifold/segments.hpp"

#include <algorithm>
#include <cmath>

namespace loopbench::methods::manifold {
namespace {

// Tolerance for rounded stamps: a gap of nominally one second may be slightly longer.
constexpr double kSlack = 1e-6;  // [parts]

double required_parts(const StampedPose& a, const StampedPose& b, const GapRule& rule) {
  const auto parts = [](double size, std::optional<double> size_max) {
    return size_max ? std::ceil(size / *size_max - kSlack) : 1.0;
  };
  const double angle = angle_between(a.world_from_body.rotation, b.world_from_body.rotation);
  return std::max(parts(b.stamp - a.stamp, rule.time_max), parts(angle, rule.rotation_max));
}

bool shares_too_little(const Problem& problem, std::size_t i, const GapRule& rule) {
  if (problem.shared_landmarks.empty() || !rule.common_min) return false;
  return static_cast<double>(problem.shared_landmarks[i]) < *rule.common_min;
}

// Returns the frame nearest to `time` in the nonempty range begin..end.
Trajectory::const_iterator nearest(Trajectory::const_iterator begin,
                                   Trajectory::const_iterator end,
                                   double time) {
  const auto after = std::lower_bound(
      begin, end, time, [](const StampedPose& pose, double t) { return pose.stamp < t; });
  if (after == begin) return begin;
  const auto before = std::prev(after);
  return after == end || time - before->stamp <= after->stamp - time ? before : after;
}

// Divides the time between two poses into `parts` equal parts and appends to `out` the tracked
// frame nearest to each division, strictly between the poses and each at most once. Returns the
// number of appended frames. O(parts log frames).
std::size_t insert_frames(const StampedPose& current,
                          const StampedPose& next,
                          std::size_t parts,
                          const Trajectory& frames,
                          Trajectory& out) {
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; };
  auto begin = std::upper_bound(frames.begin(), frames.end(), current, earlier);
  const auto end = std::lower_bound(begin, frames.end(), next, earlier);
  std::size_t inserted = 0;
  for (std::size_t part = 1; part < parts && begin != end; ++part) {
    const double share = static_cast<double>(part) / static_cast<double>(parts);
    const auto frame = nearest(begin, end, std::lerp(current.stamp, next.stamp, share));
    out.push_back(*frame);
    ++inserted;
    begin = std::next(frame);
  }
  return inserted;
}

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

NodesWithQuasiKeyframes with_quasi_keyframes(const Problem& problem, const GapRule& rule) {
  NodesWithQuasiKeyframes out;
  out.nodes.reserve(problem.keyframes.size());
  for (std::size_t i = 0; i < problem.keyframes.size(); ++i) {
    const StampedPose& current = problem.keyframes[i];
    out.nodes.push_back(current);
    if (i + 1 == problem.keyframes.size()) break;
    const StampedPose& next = problem.keyframes[i + 1];
    double parts = required_parts(current, next, rule);
    if (shares_too_little(problem, i, rule)) parts = std::max(parts, 2.0);
    if (parts < 2.0) continue;
    // Limits the number of parts, which is unbounded for a limit near zero, to the number of
    // frames.
    const auto requested =
        static_cast<std::size_t>(std::min(parts, static_cast<double>(problem.frames.size()) + 1.0));
    const std::size_t inserted = insert_frames(
        current, next, std::max<std::size_t>(requested, 2), problem.frames, out.nodes);
    out.inserted += inserted;
    if (inserted == 0) ++out.gaps_left;
  }
  return out;
}

std::vector<NodeRange> segments(const Nodes& nodes,
                                const SegmentRule& rule,
                                std::span<const double> kappa) {
  const double band = rule.speed_band ? *rule.speed_band : mean_speed(nodes);
  std::vector<NodeRange> out;
  std::size_t first = 0;
  Speeds speeds(0.0);
  for (std::size_t edge = 0; edge + 1 < nodes.size(); ++edge) {
    const double speed = nodes.step(edge).norm() / nodes.duration(edge);
    if (edge > first && speeds.admit(speed, band, rule.speed) && !(kappa[edge] > rule.turn_max)) {
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
