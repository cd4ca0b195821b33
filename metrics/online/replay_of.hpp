/// The record of a replay behind an evaluated curve.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/replay.hpp"
#include "metrics/evaluation/evaluation.hpp"

namespace loopbench::metrics {

/// Throws Undefined if there is no curve, or if the method was not replayed.
inline const Replay& replay_of(const Evaluation& evaluation, const std::string& metric) {
  const Replay* replay = needed(evaluation.context.curve, metric, "a replay").replay();
  if (replay != nullptr) return *replay;
  throw Undefined(metric + ": the method was not replayed; put `online +` in front of it");
}

/// Updates in which closures arrived or were withdrawn. Throws Undefined if there are none.
inline std::vector<ReplayUpdate> closure_updates(const Evaluation& evaluation,
                                                 const std::string& metric) {
  std::vector<ReplayUpdate> out;
  for (const ReplayUpdate& update : replay_of(evaluation, metric).updates) {
    if (update.closures > 0) out.push_back(update);
  }
  if (out.empty()) throw Undefined(metric + ": no closure arrived in the replay");
  return out;
}

}  // namespace loopbench::metrics
