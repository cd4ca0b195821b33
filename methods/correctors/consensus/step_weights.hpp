/// How unlike its neighbours each step of the odometry is.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/core/upper_median.hpp"

namespace loopbench::methods::consensus {

/// Log probability of each step from keyframe k to k + 1 to be the wrong one if there is one. Its
/// weight is 1 + d^2: the odds of a flat density over a Cauchy distribution of d, by which it
/// differs from the more similar of its neighbours, in units of the median over the chain.
/// -infinity for steps without odometry. O(keyframes).
inline std::vector<double> log_step_weights(const Problem& problem) {
  constexpr double kLeast = 1e-9;  // of a median, where all steps are equal
  std::vector<double> out(problem.keyframes.size() - 1, 0.0);
  if (problem.odometry.empty()) return out;
  std::vector<Twist> motion;
  for (const Edge& edge : problem.odometry) motion.push_back(log_se3(edge.from_from_to));
  std::vector<double> weight(motion.size(), 1.0);
  for (const int first : {0, 3}) {  // of the translation, of the rotation
    std::vector<double> change;     // from each step to the next
    for (std::size_t i = 1; i < motion.size(); ++i) {
      change.push_back((motion[i] - motion[i - 1]).segment<3>(first).norm());
    }
    std::vector<double> least;
    for (std::size_t i = 0; i < motion.size() && !change.empty(); ++i) {
      const double before = change[i > 0 ? i - 1 : 0];
      least.push_back(std::min(before, change[std::min(i, change.size() - 1)]));
    }
    if (least.empty()) continue;
    std::vector<double> sorted = least;
    const double median = std::max(kLeast, upper_median(sorted));
    for (std::size_t i = 0; i < least.size(); ++i) {
      weight[i] += least[i] * least[i] / (median * median);
    }
  }
  const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    out[problem.odometry[i].from] = weight[i] / sum;
  }
  for (double& each : out) each = std::log(each);
  return out;
}

}  // namespace loopbench::methods::consensus
