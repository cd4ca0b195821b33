/// The rotation from one direction to another.
#pragma once

#include "datasets/core/pose.hpp"

namespace loopbench {

/// The smallest rotation R with R `from` parallel to `to`; about any normal axis if they are
/// opposite.
Rotation rotation_between(const Vector3& from, const Vector3& to);

}  // namespace loopbench
