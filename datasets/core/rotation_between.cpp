#include "datasets/core/rotation_between.hpp"

#include <Eigen/Geometry>

namespace loopbench {

Rotation rotation_between(const Vector3& from, const Vector3& to) {
  return Rotation::FromTwoVectors(from, to);
}

}  // namespace loopbench
