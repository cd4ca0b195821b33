#include "harness/model/trace.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "datasets/core/replay.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/online/causal_errors.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::harness {
namespace {

/// At most kTraceSamples evenly spaced indices of 0..count-1, including the first and the last.
template <class Keep>
void visit_thinned(std::size_t count, Keep keep) {
  const std::size_t kept = std::min(count, kTraceSamples);
  for (std::size_t i = 0; i < kept; ++i) keep(kept == 1 ? 0 : i * (count - 1) / (kept - 1));
}

TracePose small(double stamp, const Pose& pose, const TraceOrigin& origin) {
  const auto f = [](double value) { return static_cast<float>(value); };
  const Vector3& p = pose.translation;
  const Rotation& q = pose.rotation;
  return {f(stamp - origin.stamp),
          f(p.x() - origin.x),
          f(p.y() - origin.y),
          f(p.z() - origin.z),
          f(q.x()),
          f(q.y()),
          f(q.z()),
          f(q.w())};
}

std::vector<TracePose> poses(const Trajectory& trajectory, const TraceOrigin& origin) {
  std::vector<TracePose> out;
  visit_thinned(trajectory.size(), [&](std::size_t i) {
    out.push_back(small(trajectory[i].stamp, trajectory[i].world_from_body, origin));
  });
  return out;
}

std::vector<TraceSample> samples(const metrics::Evaluation& evaluation, const TraceOrigin& origin) {
  std::vector<TraceSample> out;
  visit_thinned(evaluation.reference.size(), [&](std::size_t i) {
    const StampedPose& reference = evaluation.reference[i];
    const Pose& estimate = evaluation.estimate[i].world_from_body;
    const Vector3 error = estimate.translation - reference.world_from_body.translation;
    const double angle = angle_between(reference.world_from_body.rotation, estimate.rotation);
    out.push_back({small(reference.stamp, estimate, origin),
                   static_cast<float>(error.x()),
                   static_cast<float>(error.y()),
                   static_cast<float>(error.z()),
                   static_cast<float>(angle * metrics::kDegrees)});
  });
  return out;
}

/// Poses between snapshots: as many as a screen shows over the complete path.
Trajectory thinned(const Trajectory& causal) {
  constexpr std::size_t kMost = 400;
  const std::size_t step = causal.size() / kMost + 1;
  Trajectory out;
  for (std::size_t i = 0; i < causal.size(); i += step) out.push_back(causal[i]);
  return out;
}

}  // namespace

TraceOrigin trace_origin(const Sequence& sequence) {
  if (sequence.reference.empty()) {
    const Trajectory& keyframes = sequence.problem.keyframes;
    return {keyframes.empty() ? 0.0 : keyframes.front().stamp, 0.0, 0.0, 0.0};
  }
  const StampedPose& first = sequence.reference.front();
  const Vector3& p = first.world_from_body.translation;
  return {first.stamp, p.x(), p.y(), p.z()};
}

SequenceTrace sequence_trace(const Sequence& sequence) {
  SequenceTrace out;
  out.origin = trace_origin(sequence);
  out.reference = poses(sequence.reference, out.origin);
  const TraceOrigin own{out.origin.stamp, 0.0, 0.0, 0.0};
  const Trajectory& keyframes = sequence.problem.keyframes;
  out.keyframes = poses(keyframes, own);
  for (const Edge& loop : sequence.problem.closures) {
    const TracePose from =
        small(keyframes[loop.from].stamp, keyframes[loop.from].world_from_body, own);
    const TracePose to = small(keyframes[loop.to].stamp, keyframes[loop.to].world_from_body, own);
    out.closures.push_back({from.stamp, to.stamp, from.x, from.y, from.z, to.x, to.y, to.z});
  }
  return out;
}

CellTrace cell_trace(const metrics::Evaluation& evaluation,
                     metrics::Times times,
                     const TraceOrigin& origin) {
  CellTrace out{times, samples(evaluation, origin)};
  const Curve* curve = evaluation.context.curve;
  const Replay* replay = curve == nullptr ? nullptr : curve->replay();
  if (replay == nullptr || evaluation.context.reference == nullptr) return out;
  try {
    out.causal = samples(metrics::causal_evaluation(evaluation), origin);
  } catch (
      const metrics::Undefined&) {  // cannot be paired or aligned: only the snapshots are drawn
  }
  if (replay->snapshots.empty() || replay->causal.empty()) return out;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Trajectory causal = thinned(replay->causal);
  const auto add = [&](double time, Trajectory known, double after, double end) {
    for (const StampedPose& pose : causal) {
      if (pose.stamp > after && pose.stamp <= end) known.push_back(pose);
    }
    known = metrics::moved(evaluation.alignment, known);
    metrics::project(known, evaluation.protocol.project);
    out.snapshots.push_back({time - origin.stamp, poses(known, origin)});
  };
  const std::vector<ReplaySnapshot>& kept = replay->snapshots;
  add(causal.front().stamp, {}, -kInfinity, kept.front().time);  // no update so far
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double end = i + 1 == kept.size() ? kInfinity : kept[i + 1].time;
    add(kept[i].time, kept[i].poses, kept[i].time, end);
  }
  return out;
}

void add_values(CellTrace& trace,
                std::string name,
                std::string unit,
                const std::vector<double>& per_pose) {
  TraceValues& added = trace.values.emplace_back();
  added.name = std::move(name);
  added.unit = std::move(unit);
  visit_thinned(per_pose.size(),
                [&](std::size_t i) { added.values.push_back(static_cast<float>(per_pose[i])); });
}

}  // namespace loopbench::harness
