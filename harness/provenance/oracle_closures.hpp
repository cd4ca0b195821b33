/// Loop closures that were taken from the reference without saying so.
#pragma once

#include <cstddef>

#include "datasets/core/sequence.hpp"

namespace loopbench {

/// How many closures equal the reference's own relative pose to within 0.1 mm and 0.1 mrad, which
/// is far below what any sensor measures; the reference is interpolated at the keyframes' stamps.
/// Not counted: closures measured as the identity (a placeholder, or a body at rest). 0 for
/// simulated data, whose closures may be free of noise, and for a reference without attitudes.
/// O(keyframes + closures).
std::size_t closures_equal_to_reference(const Sequence& sequence);

/// Whether so many of the closures equal the reference that the rest are false or added ones: at
/// least one in twenty.
bool are_oracle_closures(std::size_t equal, std::size_t all);

}  // namespace loopbench
