/// The rotation that is closest to a matrix, and singular values.
#pragma once

#include "datasets/core/se3.hpp"

namespace loopbench {

/// The rotation R with the largest trace of R^T M (Kabsch 1976).
Matrix3 closest_rotation(const Matrix3& m);

/// In descending order.
Vector3 singular_values(const Matrix3& m);

}  // namespace loopbench
