#include "methods/correctors/shares.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>

namespace loopbench::methods {

std::vector<double> step_weights(const Trajectory& keyframes, StepWeights weights) {
  std::vector<double> shares(keyframes.size(), 1.0);
  if (weights == StepWeights::index) return shares;
  for (std::size_t i = 1; i < keyframes.size(); ++i) {
    const auto& [before, a] = keyframes[i - 1];
    const auto& [stamp, b] = keyframes[i];
    shares[i] = weights == StepWeights::time       ? stamp - before
                : weights == StepWeights::distance ? (b.translation - a.translation).norm()
                                                   : angle_between(a.rotation, b.rotation);
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
