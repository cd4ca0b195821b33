/// Errors of the poses that a robot has while it drives: of each pose at its own time.
#pragma once

#include <map>

#include "metrics/errors/ate.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/online/replay_of.hpp"
#include "metrics/trajectory/projection.hpp"

namespace loopbench::metrics {

/// The causal trajectory of a replay (replay.hpp), keyframe k with the data that had arrived at its
/// time, including closures that arrived with it; paired and aligned by the rules of the protocol
/// like any other estimate, with an alignment of its own. The replay must outlive the result.
/// Throws Undefined if the method was not replayed; `metric` is named in the reason. O(n log n).
inline Evaluation causal_evaluation(const Evaluation& evaluation,
                                    const Protocol& protocol,
                                    const std::string& metric) {
  const Replay& replay = replay_of(evaluation, metric);
  const Trajectory& reference = needed(evaluation.context.reference, metric, "a reference");
  Evaluation out = evaluate(reference, replay.causal, protocol);
  out.context = {.reference = &reference,
                 .estimate = &replay.causal,
                 .problem = evaluation.context.problem,
                 .times = Times::keyframes,
                 .protocol = protocol};
  return out;
}

inline Evaluation causal_evaluation(const Evaluation& evaluation, const std::string& metric) {
  return causal_evaluation(evaluation, evaluation.protocol, metric);
}

/// Scores of ate() and rpe() for the causal trajectory. Throws as causal_evaluation().
inline std::vector<Score> causal_ate(const Evaluation& evaluation) {
  return ate(causal_evaluation(evaluation, "causal_ate"));
}

inline std::vector<Score> causal_rpe(const Evaluation& evaluation, const RpeOptions& options) {
  return rpe(causal_evaluation(evaluation, "causal_rpe"), options);
}

/// Errors of the current keyframe before and after each update with closures, after the alignment
/// of causal_ate(): translation before, after [m]; rotation before, after [deg]. Updates at
/// keyframes that are not paired with the reference are omitted. Throws Undefined if the method was
/// not replayed or no update is left. O(n log n).
inline std::vector<Score> closure_errors(const Evaluation& evaluation) {
  const Replay& replay = replay_of(evaluation, "closure_errors");
  const Evaluation causal = causal_evaluation(evaluation, "closure_errors");
  std::map<double, std::size_t> pair_at;  // by the stamp of the estimate
  for (std::size_t i = 0; i < causal.estimate.size(); ++i) {
    pair_at.emplace(causal.estimate[i].stamp, i);
  }
  std::vector<double> metres[2];  // before, after
  std::vector<double> degrees[2];
  for (const ReplayUpdate& update : closure_updates(evaluation, "closure_errors")) {
    const double stamp = replay.causal[update.keyframes - 1].stamp;
    const auto pair = pair_at.find(stamp);
    if (pair == pair_at.end()) continue;
    const Pose& reference = causal.reference[pair->second].world_from_body;
    Trajectory poses = moved(causal.alignment, {{stamp, update.before}, {stamp, update.after}});
    project(poses, causal.protocol.project);
    for (std::size_t side = 0; side < 2; ++side) {
      const Pose& pose = poses[side].world_from_body;
      metres[side].push_back((pose.translation - reference.translation).norm());
      degrees[side].push_back(kDegrees * log_angle(pose.rotation.conjugate() * reference.rotation));
    }
  }
  if (metres[0].empty()) {
    throw Undefined("closure_errors: no update is at a keyframe that is paired with the reference");
  }
  const std::string no_rotation = why_no_attitude(causal);
  std::vector<Score> out;
  for (std::size_t side = 0; side < 2; ++side) {
    const char* name = side == 0 ? "before" : "after";
    const int ddof = evaluation.protocol.ddof;
    out.push_back({"translation", name, "m", statistics(std::move(metres[side]), ddof)});
    Score& rotation = out.emplace_back(Score{"rotation", name, "deg", {}, no_rotation});
    if (no_rotation.empty()) rotation.statistics = statistics(std::move(degrees[side]), ddof);
  }
  return out;
}

}  // namespace loopbench::metrics
