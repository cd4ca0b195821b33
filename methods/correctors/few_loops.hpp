/// Solution of a chain with few loops by the equations of its loops.
#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/looped_chain.hpp"
#include "methods/solvers/groups/scaled_pose.hpp"

namespace loopbench::methods {

/// Replaces the poses of a chain with few loops by the minimum that the equations of its loops
/// reach from the chordal relaxation, and adds their iterations. Gauss-Newton overestimates the
/// curvature of such chains (16 times on KITTI 00) and takes hundreds of steps; these equations
/// include the curvature of the loops (newton_direction()). Returns the cost at the start; 0: poses
/// are unchanged.
inline double solve_loops(const Problem& problem, std::vector<ScaledPose>& poses, int& iterations) {
  constexpr int kFewLoops = 20;  // the time of an iteration grows with the cube
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-12;  // relative change of the cost
  if (!problem.anchors.empty() || !loops_fault(problem, kFewLoops).empty()) return 0.0;
  const NoiseModel noise_model = stated_noise_model(problem);
  std::optional<LoopedChain> chain = chordal_chain(problem, noise_model);
  if (!chain) return 0.0;
  const double before = chain->cost();
  try {
    iterations += chain->minimise(kMaxIterations, kConverged);
  } catch (const std::runtime_error&) {  // not positive definite to rounding
    return 0.0;
  }
  const Trajectory solved = chain->keyframes();
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].pose = solved[i].world_from_body;
  return before;
}

}  // namespace loopbench::methods
