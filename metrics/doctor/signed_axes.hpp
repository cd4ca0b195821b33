/// Permutations of axes with signs.
#pragma once

#include <string>
#include <vector>

#include "datasets/core/se3.hpp"

namespace loopbench::metrics {

/// The 47 signed permutations of three axes but the identity; 24 of all 48 are rotations.
const std::vector<Matrix3>& signed_axes();

/// Source axis of each axis: "x,-y,z".
std::string axes_option(const Matrix3& axes);

}  // namespace loopbench::metrics
