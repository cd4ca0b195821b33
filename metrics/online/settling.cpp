#include "metrics/online/settling.hpp"

#include <fmt/format.h>

#include "metrics/numerics/angle.hpp"
#include "metrics/online/replay_of.hpp"

namespace loopbench::metrics {

std::vector<Score> settling(const Evaluation& evaluation, const NoOptions&) {
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
