/// How much past poses still move, by their age.
#pragma once

#include <fmt/format.h>

#include "metrics/metric.hpp"
#include "metrics/numerics/angle.hpp"
#include "metrics/online/replay_of.hpp"

namespace loopbench::metrics {

/// For each class of age (kAges in replay.hpp; the axis is its lower limit): root mean square over
/// its keyframes of the distance [m], scaled by the alignment, and of the rotation angle [deg] that
/// an update with closures moves them. The statistics are over the updates that had such keyframes;
/// a class without any has no score. Needs no reference. Throws Undefined if the method was not
/// replayed or no closure arrived. O(updates).
inline std::vector<Score> settling(const Evaluation& evaluation, const NoOptions& = {}) {
  const std::vector<ReplayUpdate> updates = closure_updates(evaluation, "settling");
  const int ddof = evaluation.protocol.ddof;
  std::vector<Score> out;
  for (std::size_t age = 0; age < kAges.size(); ++age) {
    std::vector<double> metres;
    std::vector<double> degrees;
    for (const ReplayUpdate& update : updates) {
      const Movement& moved = update.moved[age];
      if (moved.poses == 0) continue;
      metres.push_back(evaluation.alignment.scale * moved.translation);
      degrees.push_back(kDegrees * moved.rotation);
    }
    if (metres.empty()) continue;
    const std::string axis = fmt::format("{:g} s", kAges[age]);
    out.push_back({"translation", axis, "m", statistics(std::move(metres), ddof)});
    out.push_back({"rotation", axis, "deg", statistics(std::move(degrees), ddof)});
  }
  if (out.empty()) throw Undefined("settling: no keyframe is older than an update");
  return out;
}

}  // namespace loopbench::metrics
