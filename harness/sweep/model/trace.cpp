#include "harness/sweep/model/trace.hpp"

#include <utility>

#include "harness/sweep/model/loops.hpp"
#include "metrics/numerics/angle.hpp"

namespace loopbench::harness {
namespace {

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
  for (const std::size_t i : subsampled_indices(trajectory.size(), kTraceSamples)) {
    out.push_back(small(trajectory[i].stamp, trajectory[i].world_from_body, origin));
  }
  return out;
}

std::vector<TraceSample> samples(const metrics::Evaluation& evaluation, const TraceOrigin& origin) {
  std::vector<TraceSample> out;
  for (const std::size_t i : subsampled_indices(evaluation.reference.size(), kTraceSamples)) {
    const StampedPose& reference = evaluation.reference[i];
    const Pose& estimate = evaluation.estimate[i].world_from_body;
    const Vector3 error = estimate.translation - reference.world_from_body.translation;
    const double angle = angle_between(reference.world_from_body.rotation, estimate.rotation);
    out.push_back({small(reference.stamp, estimate, origin),
                   static_cast<float>(error.x()),
                   static_cast<float>(error.y()),
                   static_cast<float>(error.z()),
                   static_cast<float>(angle * metrics::kDegrees)});
  }
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
  out.ledger = stored_ledger(sequence.problem);
  return out;
}

CellTrace cell_trace(const metrics::Evaluation& evaluation,
                     metrics::Times times,
                     const TraceOrigin& origin) {
  return {times, samples(evaluation, origin)};
}

void add_values(CellTrace& trace,
                std::string name,
                std::string unit,
                const std::vector<double>& per_pose) {
  TraceValues& added = trace.values.emplace_back();
  added.name = std::move(name);
  added.unit = std::move(unit);
  for (const std::size_t i : subsampled_indices(per_pose.size(), kTraceSamples)) {
    added.values.push_back(static_cast<float>(per_pose[i]));
  }
}

}  // namespace loopbench::harness
