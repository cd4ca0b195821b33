/// Errors of the poses that a robot has while it drives: of each pose at its own time.
#pragma once

#include "metrics/errors/rpe.hpp"
#include "metrics/metric.hpp"

namespace loopbench::metrics {

/// The causal trajectory of a replay (replay.hpp), keyframe k with the data that had arrived at its
/// time, including closures that arrived with it; paired and aligned by the rules of the protocol
/// like any other estimate, with an alignment of its own. The replay must outlive the result.
/// Throws Undefined if the method was not replayed; `metric` is named in the reason. O(n log n).
Evaluation causal_evaluation(const Evaluation& evaluation, const std::string& metric = "causal");

/// Scores of ate() and rpe() for the causal trajectory. Throws as causal_evaluation().
std::vector<Score> causal_ate(const Evaluation& evaluation);
std::vector<Score> causal_rpe(const Evaluation& evaluation, const RpeOptions& options);

/// Errors of the current keyframe before and after each update with closures, after the alignment
/// of causal_ate(): translation before, after [m]; rotation before, after [deg]. Updates at
/// keyframes that are not paired with the reference are omitted. Throws Undefined if the method was
/// not replayed or no update is left. O(n log n).
std::vector<Score> closure_errors(const Evaluation& evaluation);

}  // namespace loopbench::metrics
