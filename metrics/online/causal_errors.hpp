/// Errors of the poses that a robot has while it drives: of each pose at its own time.
#pragma once

#include "metrics/errors/ate.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/metric.hpp"
#include "metrics/online/replay_of.hpp"

namespace loopbench::metrics {

/// The causal trajectory of a replay (replay.hpp), keyframe k with the data that had arrived at its
/// time, including closures that arrived with it; paired and aligned by the rules of the protocol
/// like any other estimate, with an alignment of its own. The replay must outlive the result.
/// Throws Undefined if the method was not replayed; `metric` is named in the reason. O(n log n).
inline Evaluation causal_evaluation(const Evaluation& evaluation, const std::string& metric) {
  const Replay& replay = replay_of(evaluation, metric);
  const Trajectory& reference = needed(evaluation.context.reference, metric, "a reference");
  Evaluation out = evaluate(reference, replay.causal, evaluation.protocol);
  out.context = {.reference = &reference,
                 .estimate = &replay.causal,
                 .problem = evaluation.context.problem,
                 .times = Times::keyframes,
                 .protocol = evaluation.protocol};
  return out;
}

/// Scores of ate() and rpe() for the causal trajectory. Throws as causal_evaluation().
inline std::vector<Score> causal_ate(const Evaluation& evaluation) {
  return ate(causal_evaluation(evaluation, "causal_ate"));
}

inline std::vector<Score> causal_rpe(const Evaluation& evaluation, const RpeOptions& options) {
  return rpe(causal_evaluation(evaluation, "causal_rpe"), options);
}

}  // namespace loopbench::metrics
