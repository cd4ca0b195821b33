/// For how long the pose that a robot has is wrong.
#pragma once

#include <algorithm>

#include "metrics/online/causal_errors.hpp"

namespace loopbench::metrics {

struct CausalLapseOptions {
  double limit = 1.0;
};

template <class Visit>
void fields(CausalLapseOptions& o, Visit visit) {
  visit("limit", o.limit, "error of the current pose above which it counts [m]", GreaterThan{0.0});
}

/// Of the causal trajectory, aligned as the last one (its own alignment would suffer from what is
/// measured): `longest` [s], from the first keyframe with an error above the limit to the next one
/// without (or the last one), and `share` [%] of the time that all such stretches take. Throws as
/// causal_evaluation(). O(n log n).
inline std::vector<Score> causal_lapse(const Evaluation& evaluation,
                                       const CausalLapseOptions& options) {
  Protocol unaligned = evaluation.protocol;
  unaligned.align = Align::none;
  unaligned.project = ProjectionPlane::none;  // comes after the alignment
  const Evaluation causal = causal_evaluation(evaluation, unaligned, "causal_lapse");
  Trajectory poses = moved(evaluation.alignment, causal.estimate);
  Trajectory reference = causal.reference;
  project(poses, evaluation.protocol.project);
  project(reference, evaluation.protocol.project);
  double longest = 0.0, total = 0.0, stretch = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Vector3 error =
        poses[i - 1].world_from_body.translation - reference[i - 1].world_from_body.translation;
    const double step = poses[i].stamp - poses[i - 1].stamp;
    stretch = error.norm() > options.limit ? stretch + step : 0.0;
    longest = std::max(longest, stretch);
    total += stretch > 0.0 ? step : 0.0;
  }
  const double duration = poses.empty() ? 0.0 : poses.back().stamp - poses.front().stamp;
  if (!(duration > 0.0)) throw Undefined("causal_lapse: needs poses at two times");
  return {single("longest", "", "s", longest), single("share", "", "%", 100.0 * total / duration)};
}

}  // namespace loopbench::metrics
