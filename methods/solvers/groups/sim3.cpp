#include "methods/solvers/groups/sim3.hpp"

#include "datasets/core/factorisations.hpp"

namespace loopbench::methods {
namespace {

/// Returns the matrix of [xi, .], the derivative of the adjoint.
Sim3::Square bracket(const Sim3::Tangent& xi) {
  Sim3::Square out = Sim3::Square::Zero();
  out.topLeftCorner<3, 3>() = hat(xi.segment<3>(3)) + xi[6] * Matrix3::Identity();
  out.block<3, 3>(0, 3) = hat(xi.head<3>());
  out.block<3, 1>(0, 6) = -xi.head<3>();
  out.block<3, 3>(3, 3) = hat(xi.segment<3>(3));
  return out;
}

/// Returns the W in translation(exp(xi)) = W rho: the integral of e^(u lambda) Exp(u phi) over u
/// in 0..1.
Matrix3 translation_jacobian(const Vector3& phi, double lambda) {
  // Halving as in left_jacobian, for the 3 x 3 matrix A = hat(phi) + lambda I.
  const Matrix3 A = hat(phi) + lambda * Matrix3::Identity();
  int halvings = 0;
  double part = 1.0;
  const double size = std::sqrt(phi.squaredNorm() + lambda * lambda);
  for (; part * size > 0.25; ++halvings) part *= 0.5;
  Matrix3 out = Matrix3::Identity();
  Matrix3 term = Matrix3::Identity();
  for (int k = 2; k <= 14; ++k) {
    term = (term * A).eval() * (part / static_cast<double>(k));
    out += term;
  }
  for (; halvings > 0; --halvings) {
    const Matrix3 rotation = std::exp(part * lambda) * exp_so3(part * phi).toRotationMatrix();
    out = (0.5 * (Matrix3::Identity() + rotation) * out).eval();
    part *= 2.0;
  }
  return out;
}

}  // namespace

ScaledPose Sim3::exp(const Tangent& xi) {
  const Vector3 phi = xi.segment<3>(3);
  return {{exp_so3(phi), translation_jacobian(phi, xi[6]) * xi.head<3>()}, std::exp(xi[6])};
}

Sim3::Tangent Sim3::log(const ScaledPose& a) {
  const Vector3 phi = log_so3(a.pose.rotation);
  const double lambda = std::log(a.scale);
  Tangent out;
  out << translation_jacobian(phi, lambda).partialPivLu().solve(a.pose.translation), phi, lambda;
  return out;
}

Sim3::Square Sim3::adjoint(const ScaledPose& a) {
  const Matrix3 R = a.pose.rotation.toRotationMatrix();
  Square out = Square::Zero();
  out.topLeftCorner<3, 3>() = a.scale * R;
  out.block<3, 3>(0, 3) = hat(a.pose.translation) * R;
  out.block<3, 1>(0, 6) = -a.pose.translation;
  out.block<3, 3>(3, 3) = R;
  out(6, 6) = 1.0;
  return out;
}

Sim3::Square Sim3::left_jacobian(Tangent xi) {
  int halvings = 0;
  for (; xi.norm() > 0.25; ++halvings) xi *= 0.5;
  const Square ad = bracket(xi);
  Square out = Square::Identity();
  Square term = Square::Identity();
  for (int k = 2; k <= 14; ++k) {
    term = (term * ad).eval() / static_cast<double>(k);
    out += term;
  }
  for (; halvings > 0; --halvings) {
    out = (0.5 * (Square::Identity() + adjoint(exp(xi))) * out).eval();
    xi *= 2.0;
  }
  return out;
}

Sim3::Square Sim3::inverse_right_jacobian(const Tangent& xi) {
  return inverse_of(left_jacobian(-xi));
}

}  // namespace loopbench::methods
