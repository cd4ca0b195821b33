/// Where one body sits in another whose axes are known.
#pragma once

#include <vector>

#include "datasets/core/so3.hpp"

namespace loopbench {

/// moved = turned c + s way + k, a pair each: R_C t_Q - t_Z, R_Z - I and R_C t_Q.
struct LeverEquation {
  Matrix3 turned;
  Vector3 way;
  Vector3 moved;
  double weight = 1.0;
};

struct LeverFit {
  Vector3 lever = Vector3::Zero();      ///< c in the reference's unit; 0 where nothing tells [m]
  Vector3 deviation = Vector3::Zero();  ///< standard deviations, 0: not told [m]
  double explained = 0.0;               ///< part of the squares that the scale leaves [-]
};

/// Least squares with Huber's weights, any scale, and drift of a few per cent a stretch; directions
/// are told that lie three deviations from zero. See hand_eye(). O(equations).
LeverFit fit_lever(std::vector<LeverEquation> equations);

}  // namespace loopbench
