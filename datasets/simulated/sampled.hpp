/// A path as a list of poses, evenly in time.
#pragma once

#include "datasets/core/trajectory.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

/// Poses at k / rate from 0 to `seconds`, flattened to z = 0 and a heading when `planar`. Repeats
/// of a sequence differ in their noise, not in where they went, and a path's sines cost more than
/// all noise: so the list asked for last is remembered. Thread-safe. Throws OptionError for too
/// many.
Trajectory sampled(SimulatedPath which, double rate, double seconds, bool planar);

}  // namespace loopbench
