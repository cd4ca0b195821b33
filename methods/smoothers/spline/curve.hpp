/// Spline curve of order k: a B-spline in position and a cumulative B-spline in rotation on the
/// same knots.
#pragma once

#include <array>
#include <utility>

#include "datasets/core/knot_curve.hpp"
#include "methods/smoothers/spline/basis.hpp"

namespace loopbench::methods {

/// p(t) = sum_j N_j(t) c_j,   R(t) = C_0 prod_{j>=1} Exp(B_j(t) Log(C_{j-1}^T C_j)),
/// B_j = N_j + N_{j+1} + ... Both are C^{k-2} in time. O(k^2) per time for sorted times.
/// Source: Kim, Kim & Shin 1995; Sommer et al., CVPR 2020.
class CumulativeCurve final : public KnotCurve {
 public:
  /// Requires one control pose per basis function.
  CumulativeCurve(SplineBasis basis, const std::vector<Pose>& controls)
      : KnotCurve(basis.breaks()), basis_(std::move(basis)), controls_(controls.size()) {
    for (std::size_t j = 0; j < controls.size(); ++j) {
      controls_[j] = {controls[j], Vector3::Zero()};
      if (j == 0) continue;
      controls_[j].step = log_so3(controls[j - 1].rotation.conjugate() * controls[j].rotation);
    }
  }

 private:
  Pose evaluate(std::size_t piece, double time) const override {
    const SplineBasis::Values B = basis_.cumulative(piece, time);
    const Control* c = &controls_[piece];
    Vector3 point = c[0].pose.translation;
    Rotation rotation = c[0].pose.rotation;
    for (std::size_t j = 1; j < basis_.order(); ++j) {
      point += B[j] * (c[j].pose.translation - c[j - 1].pose.translation);
      rotation = rotation * exp_so3(B[j] * c[j].step);
    }
    return {rotation.normalized(), point};
  }

  struct Control {
    Pose pose;
    Vector3 step;  ///< Log(C_{j-1}^T C_j) [rad]
  };

  SplineBasis basis_;
  std::vector<Control> controls_;
};

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
