/// Problems with known true and false closures, planted on chains with a known truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/studies/true_chains.hpp"

namespace loopbench {

enum class Plant {
  none,
  false_20,
  false_40,
  family,      ///< four false closures that agree with each other
  slipped,     ///< a fifth has ten times the deviation of its translation
  heavy,       ///< errors of Student's t with 2 degrees of freedom
  correlated,  ///< closures in groups of four that share an error of their deviation
  one,         ///< one true closure
  two,
  three,
  one_of_one_false,
  one_of_two_false,
  one_of_three_false,
  wrong_step,        ///< one step of the odometry has a hundred times its deviation
  wrong_step_30,     ///< thirty times
  wrong_step_false,  ///< a hundred times, and a fifth of the closures is false
  restart,           ///< at one step the odometry starts again at the pose of the first keyframe
  bias,              ///< none false, on a chain with a biased odometry
  bias_false,        ///< a fifth of the closures is false, on such a chain
};
inline constexpr Plant kLastPlant = Plant::bias_false;

std::string name_of(Plant plant);

/// Plants for which closures are Gaussian, and none slipped.
bool is_gaussian(Plant plant);

/// Plants that need a chain of biased().
bool is_biased(Plant plant);

struct PlantedProblem {
  Problem problem;
  std::vector<bool> is_false;                  ///< of each closure
  std::optional<std::size_t> wrong_step = {};  ///< keyframe where it begins
};

/// `odometry`: factor on the stated deviations of the odometry, 1: as in the chain.
PlantedProblem planted(const TrueChain& chain, Plant plant, double odometry, std::int64_t seed);

}  // namespace loopbench
