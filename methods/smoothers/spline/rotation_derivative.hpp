/// Derivative of a cumulative spline on SO(3) with respect to its controls.
#pragma once

#include <array>

#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods {

struct RotationDerivative {
  Rotation rotation;                                 ///< R(t)
  std::array<Matrix3, SplineBasis::kMaxOrder> by{};  ///< derivative by control p + j, j < order
};

/// With controls perturbed to Exp(a_j) C_j, R(t) becomes Exp(sum_j by[j] a_j) R(t) to first order.
/// `controls` points to the first of `order` rotations; B are the cumulative basis values.
/// O(order). Source: chain rule for F_j = F_{j-1} Exp(B_j d_j); compare Sommer et al., CVPR 2020.
inline RotationDerivative rotation_derivative(const Rotation* controls,
                                              std::size_t order,
                                              const SplineBasis::Values& B) {
  RotationDerivative out;
  out.rotation = controls[0];
  out.by[0] = Matrix3::Identity();
  for (std::size_t j = 1; j < order; ++j) {
    const Vector3 step = log_so3(controls[j - 1].conjugate() * controls[j]);
    const Matrix3 K = B[j] * left_jacobian_so3(B[j] * step) * inverse_left_jacobian_so3(step);
    const Matrix3 M =
        out.rotation.toRotationMatrix() * K * controls[j - 1].conjugate().toRotationMatrix();
    out.rotation = out.rotation * exp_so3(B[j] * step);
    out.by[j - 1] -= M;
    out.by[j] = M;
  }
  return out;
}

}  // namespace loopbench::methods
