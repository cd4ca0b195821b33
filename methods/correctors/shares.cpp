#include "methods/correctors/shares.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

#include "methods/correctors/anchors.hpp"

namespace loopbench::methods {

std::vector<double> step_weights(const Trajectory& keyframes, StepWeights weights) {
  std::vector<double> shares(keyframes.size(), 1.0);
  if (weights == StepWeights::index) return shares;
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const auto& [before, a] = keyframes[i - 1];
    const auto& [stamp, b] = keyframes[i];
    if (weights == StepWeights::time) shares[i] = stamp - before;
    if (weights == StepWeights::distance) shares[i] = (b.translation - a.translation).norm();
    if (weights == StepWeights::rotation) shares[i] = angle_between(a.rotation, b.rotation);
  }
  return shares;
}

std::optional<LoopShares> loop_shares(const std::vector<double>& shares,
                                      const std::vector<bool>& frozen,
                                      const Edge& loop) {
  LoopShares out{std::vector<double>(loop.to - loop.from), false};
  const auto accumulate = [&](auto share_of) {
    double sum = 0.0;
    for (std::size_t k = 0; k < out.cumulative.size(); ++k) {
      const std::size_t i = loop.from + 1 + k;
      out.cumulative[k] = sum += frozen[i] ? 0.0 : share_of(i);
    }
    return sum;
  };
  double total = accumulate([&](std::size_t i) { return shares[i]; });
  if (!(total > 0.0)) {  // no motion along the loop: equal shares
    total = accumulate([](std::size_t) { return 1.0; });
    if (total == 0.0) return std::nullopt;
    out.used_equal_shares = true;
  }
  for (double& w : out.cumulative) w /= total;
  return out;
}

std::string LoopCorrector::why_declined(const Problem& problem) const {
  const bool is_empty = problem.closures.empty() && problem.anchors.empty();
  return is_empty ? "the problem has no loop closures" : anchors_fault(problem);
}

LoopCorrection::LoopCorrection(const Pose& start,
                               const Pose& end,
                               const Edge& loop,
                               bool with_rotation)
    : pivot(start.translation) {
  const Pose target = start * loop.from_from_to;
  phi = with_rotation ? log_so3(target.rotation * end.rotation.conjugate())
                      : Vector3(Vector3::Zero());
  shift = target.translation - (exp_so3(phi) * (end.translation - pivot) + pivot);
}

Pose LoopCorrection::moved(double share, const Pose& pose) const {
  const Rotation part = exp_so3(share * phi);
  return normalized(
      Pose{part * pose.rotation, part * (pose.translation - pivot) + pivot + share * shift});
}

void report_closing_errors(const Problem& problem, const Trajectory& corrected, Report& report) {
  double largest = 0.0;
  for (const Edge& loop : problem.closures) {
    const Pose target = corrected[loop.from].world_from_body * loop.from_from_to;
    const Vector3& end = corrected[loop.to].world_from_body.translation;
    largest = std::max(largest, (target.translation - end).norm());
  }
  report.count("closures", static_cast<double>(problem.closures.size()));
  report.count("largest_closing_error", largest);
}

void check_closures(const Problem& problem, const char* method) {
  const auto order = [](const Edge& loop) { return std::tuple(loop.to, loop.from); };
  const auto is_valid = [&](const Edge& loop) {
    return loop.from < loop.to && loop.to < problem.keyframes.size();
  };
  if (!std::ranges::is_sorted(problem.closures, {}, order) ||
      !std::ranges::all_of(problem.closures, is_valid)) {
    throw std::runtime_error(
        std::string(method) +
        ": closures must refer to existing keyframes with from < to and be sorted by (to, from)");
  }
}

}  // namespace loopbench::methods
