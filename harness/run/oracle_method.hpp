/// Detection of methods that use the reference they are evaluated against.
#pragma once

#include <string>

#include "datasets/core/trajectory.hpp"
#include "harness/catalogue/catalogue.hpp"
#include "harness/model/sweep.hpp"

namespace loopbench::harness {

/// Whether a stage is an oracle (MethodEntry::make_oracle).
bool uses_reference(const MethodChoice& method, const Catalogue& catalogue);

/// Whether all positions are equal to within 1e-9 of the reference's largest distance from its
/// first one. False for fewer than three poses, and for a reference at rest. O(n).
bool has_equal_positions(const Trajectory& estimate, const Trajectory& reference);

}  // namespace loopbench::harness
