/// Detection of estimates that are the reference.
#pragma once

#include <string>

#include "datasets/core/sequence.hpp"

namespace loopbench::harness {

/// "the estimate equals the reference" or "the frames equal the reference", if all keyframes (or
/// frames) have the relative poses of the reference to within 0.1 mm and 0.1 mrad, in any world
/// frame; otherwise empty. The reference is interpolated at their stamps; at least half of them,
/// and a motion beyond these limits, are needed. Empty for simulated data, whose odometry can be
/// noise-free, and for a reference without orientations. O(poses).
std::string copied_reference(const Sequence& sequence);

}  // namespace loopbench::harness
