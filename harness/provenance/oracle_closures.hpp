/// Detection of loop closures that were computed from the reference without a declaration.
#pragma once

#include <cstddef>

#include "datasets/core/sequence.hpp"

namespace loopbench::harness {

/// Number of closures that equal the reference's relative pose to within 0.1 mm and 0.1 mrad, far
/// below sensor noise; the reference is interpolated at the keyframe stamps. Closures measured as
/// the identity are not counted (a placeholder, or a body at rest). 0 for simulated data, whose
/// closures can be noise-free, and for a reference without orientations. O(keyframes + closures).
std::size_t closures_equal_to_reference(const Sequence& sequence);

/// Whether at least one in twenty closures equals the reference, so that the others can be added
/// false closures.
bool are_oracle_closures(std::size_t equal, std::size_t all);

}  // namespace loopbench::harness
