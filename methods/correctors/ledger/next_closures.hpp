/// Where one more loop closure would determine the positions best.
#pragma once

#include <cstddef>
#include <vector>

#include "datasets/core/problem.hpp"

namespace loopbench::methods {

struct NextClosure {
  std::size_t from = 0, to = 0;  ///< keyframes
  double metres = 0.0;           ///< distance between them in the solution
  double deviation = 0.0;        ///< of the positions with it: root mean square [m]
};

struct NextClosures {
  double deviation = 0.0;          ///< of the positions in the solution: root mean square [m]
  std::vector<NextClosure> found;  ///< at different places, the one of the largest effect first
};

/// The `count` closures between about 40 evenly spaced keyframes with which the mean variance of
/// all positions, relative to the first pose, would be smallest. Each is as certain as the median
/// closure of the problem. Its keyframes can have seen the same: they are at most as far apart as
/// those of the longest closure, with two standard deviations of their distance. Requires
/// why_no_ledger() to be empty. Memory: a few factors, and two
/// columns of blocks of its inverse. Throws std::runtime_error if the solver finds no solution.
NextClosures next_closures(const Problem& problem, std::size_t count = 3);

}  // namespace loopbench::methods
