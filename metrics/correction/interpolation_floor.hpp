/// Interpolation error between keyframes if every keyframe were exact.
#pragma once

#include "datasets/core/cubic.hpp"
#include "datasets/core/interpolate.hpp"
#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/pairing/association.hpp"

namespace loopbench::metrics {

struct InterpolationFloorOptions {
  double max_gap = 0.1;
};

template <class Visit>
void fields(InterpolationFloorOptions& o, Visit visit) {
  visit("max_gap", o.max_gap, "largest reference gap around a keyframe [s]", GreaterThan{0.0});
}

/// Runs of consecutive keyframes at which the reference is defined.
inline std::vector<Trajectory> keyframe_runs(const Trajectory& reference,
                                             const std::vector<double>& keyframe_stamps,
                                             double max_gap) {
  std::vector<Trajectory> out(1);
  std::size_t after = 0;
  for (const double stamp : keyframe_stamps) {
    if (const auto pose = pose_at(reference, stamp, max_gap + kStampRounding, after)) {
      out.back().push_back({stamp, *pose});
    } else if (!out.back().empty()) {
      out.emplace_back();
    }
  }
  return out;
}

struct Floor {
  std::vector<double> polyline;  ///< [m]
  std::vector<double> cubic;     ///< [m]
  std::vector<double> slerp;     ///< [deg]
  bool has_between = false;      ///< a reference pose other than a keyframe was evaluated
};

/// Evaluates one run of keyframes; `next` is the first reference pose after all earlier runs.
inline void add_run(Floor& floor,
                    const Trajectory& nodes,
                    const Trajectory& reference,
                    std::size_t& next) {
  if (nodes.size() < 2) return;
  std::vector<Vector3> points;
  for (const StampedPose& node : nodes) points.push_back(node.world_from_body.translation);
  const std::vector<Vector3> second_derivatives =
      cubic_second_derivatives<Vector3>(stamps(nodes), points);
  const auto knot = [&](std::size_t k) -> CubicKnot<Vector3> {
    return {nodes[k].stamp, points[k], second_derivatives[k]};
  };
  std::size_t i = 0;
  for (; next < reference.size() && reference[next].stamp <= nodes.back().stamp; ++next) {
    const auto& [stamp, truth] = reference[next];
    if (stamp < nodes.front().stamp) continue;
    while (i + 2 < nodes.size() && nodes[i + 1].stamp <= stamp) ++i;
    const StampedPose& a = nodes[i];
    const StampedPose& b = nodes[i + 1];
    const Pose line = interpolate(a, b, stamp);
    floor.polyline.push_back((line.translation - truth.translation).norm());
    const auto cubic = cubic_between<Vector3>(knot(i), knot(i + 1), stamp);
    floor.cubic.push_back((cubic - truth.translation).norm());
    floor.slerp.push_back(kDegrees * angle_between(line.rotation, truth.rotation));
    floor.has_between |= stamp != a.stamp && stamp != b.stamp;
  }
}

/// Samples the reference at the keyframe stamps, interpolates, and compares with the reference at
/// each of its stamps in between: polyline 3d [m] (linear), natural_cubic 3d [m] (natural cubic
/// spline in time), slerp 3d [deg]. Depends only on the keyframe stamps of a method, so the value
/// is the same in every row of a table. In files every pose is a keyframe. Keyframes outside the
/// reference or in a reference gap are not exact; the interpolation is split there. Throws
/// Undefined if no reference pose lies between two keyframes. O(n + m).
inline std::vector<Score> interpolation_floor(const Evaluation& evaluation,
                                              const InterpolationFloorOptions& options) {
  const Context& context = evaluation.context;
  const Trajectory& reference = needed(context.reference, "the complete reference");
  std::vector<double> keyframe_stamps = stamps(needed(context.estimate, "the complete estimate"));
  for (double& stamp : keyframe_stamps) stamp += context.protocol.offset;

  Floor floor;
  std::size_t next = 0;
  for (const Trajectory& nodes : keyframe_runs(reference, keyframe_stamps, options.max_gap)) {
    add_run(floor, nodes, reference, next);
  }
  if (!floor.has_between) {
    throw Undefined("the reference has no pose between keyframes");
  }
  const int ddof = evaluation.protocol.ddof;
  Score slerp{"slerp", "3d", "deg", {}, why_no_attitude(evaluation)};
  if (slerp.why_undefined.empty()) slerp.statistics = statistics(std::move(floor.slerp), ddof);
  return descriptions({{"polyline", "3d", "m", statistics(std::move(floor.polyline), ddof)},
                       {"natural_cubic", "3d", "m", statistics(std::move(floor.cubic), ddof)},
                       std::move(slerp)});
}

}  // namespace loopbench::metrics
