/// A sequence made from a closed-form path, an odometer that errs and a place recogniser.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

/// Frames lie at k / frame_rate, keyframes are an even choice of them with both ends, so frames
/// and keyframes share one drifting world; the world of the first frame is the reference's.
/// `frames` holds every tracked frame, keyframes included. Closures are legitimate measurements:
/// truth + noise with matching information. Throws OptionError. O(frames + reference poses).
Sequence load_simulated(const SimulatedOptions& options, const DataRoot& root = {});

}  // namespace loopbench
