/// Loop closures measured in another trajectory of the same sequence: its reference or another run.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/core/problem.hpp"
#include "datasets/derive/poses_at.hpp"
#include "datasets/noise_stream.hpp"
#include "datasets/revisits.hpp"

namespace loopbench {

struct ClosureNoise {
  double sigma_t = 0.02;  ///< [m]
  double sigma_r = 0.01;  ///< [rad]
};

/// Where `run` is known at keyframe stamps and returns to a place, the closure between those
/// keyframes is the run's own relative pose. At most `max` of them, well spread; 0 takes all. Both
/// must follow the same body (the same camera): nothing is calibrated here.
/// Sorted by (to, from); information from `noise`. O(n + revisits * max).
std::vector<Edge> closures_in_run(const Trajectory& keyframes,
                                  const Trajectory& run,
                                  const RevisitRule& rule,
                                  std::size_t max,
                                  const Reach& reach,
                                  const ClosureNoise& noise);

/// measured = true * exp(e), e ~ N(0, diag(sigma_t^2, sigma_r^2)), drawn in the order of edges.
std::vector<Edge> with_noise(std::vector<Edge> edges,
                             const ClosureNoise& noise,
                             const NoiseStream& stream);

/// The run's path length over the estimate's, both through the stamps they share; 1 when there are
/// fewer than two. Monocular runs have a scale each: then this is far from 1.
double path_ratio(const Trajectory& keyframes, const Trajectory& run, const Reach& reach);

/// For a run whose unit of length is its own and an estimate whose unit creeps (monocular):
/// closures measured in the run become those of Sim(3). At a keyframe the estimate's unit is as
/// many of the run's as the run's way is longer over the ten shared keyframes to either side; edges
/// get the ratio of `to`'s to `from`'s, and their translation is put in `from`'s. Throws InputError
/// when one of the two does not move there. O(n).
std::vector<Edge> with_local_scale(std::vector<Edge> edges,
                                   const Trajectory& keyframes,
                                   const Trajectory& run,
                                   const Reach& reach);

/// Puts closures in the order that Problem promises.
void sort_closures(std::vector<Edge>& closures);

}  // namespace loopbench
