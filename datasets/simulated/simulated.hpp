/// The dataset `simulated`: a closed-form path with simulated odometry and loop closures.
#pragma once

#include "datasets/dataset.hpp"
#include "datasets/simulated/options.hpp"

namespace loopbench {

/// Frames have stamps k / frame_rate. Keyframes are evenly spaced frames, including the first and
/// the last. `frames` contains all tracked frames, including keyframes; the first one has its true
/// pose. Closures are true relative poses with noise of the stated information. Throws OptionError.
/// O(frames + reference poses).
Sequence load_simulated(const SimulatedOptions& options, const DataRoot& root = {});

/// Samples the path, which sequences with other seeds share (the last one is kept). Does nothing
/// for paths that are too long for the cache.
void prepare_simulated(const SimulatedOptions& options);

DatasetEntry simulated_entry();

}  // namespace loopbench
