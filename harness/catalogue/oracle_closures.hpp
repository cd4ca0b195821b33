/// Loop closures that were taken from the reference without a declaration.
#pragma once

#include <cstddef>

#include "datasets/core/sequence.hpp"

namespace loopbench::harness {

/// Limits within which a pose is a copy of the reference's.
inline constexpr double kCopyDistance = 1e-4;  // [m]; rounding of trajectory files is at most this
inline constexpr double kCopyAngle = 1e-4;     // [rad]

/// Number of closures that equal the reference's relative pose to within 0.1 mm and 0.1 mrad, far
/// below sensor noise; the reference is interpolated at the keyframe stamps. Closures measured as
/// the identity are not counted (a placeholder, or a body at rest). 0 if fewer than one in twenty
/// are equal (the others can be added false closures), for simulated data, whose closures can be
/// noise-free, and for a reference without orientations. O(keyframes + closures).
std::size_t undeclared_oracle_closures(const Sequence& sequence);

}  // namespace loopbench::harness
