/// Prior residual between two neighbouring states, and its Jacobians.
#pragma once

#include <array>

#include "methods/smoothers/gp/body_rate.hpp"
#include "methods/smoothers/gp/prior.hpp"

namespace loopbench::methods {

/// Pose, body twist per unit of time, and for P = 3 its derivative. The pose is perturbed by Exp(d)
/// on the right.
template <int P>
struct GpState {
  Pose pose;
  std::array<Twist, P - 1> rates;
};

template <int P>
using GpVector = Eigen::Matrix<double, 6 * P, 1>;
template <int P>
using GpMatrix = Eigen::Matrix<double, 6 * P, 6 * P>;

/// Local coordinates of state j relative to state i: xi(t) = Log(T_i^-1 T(t)) and its derivatives
/// at j. They are xi, J_r^-1(xi) w_j, and for P = 3 also ad(J_r^-1 w_j) w_j / 2 + J_r^-1(xi) a_j
/// (Tang 2019, up to terms of order xi). At state i they are 0, w_i, a_i.
template <int P>
struct LocalState {
  std::array<Twist, P> value;  ///< local coordinates of j
  GpMatrix<P> by_from = GpMatrix<P>::Zero();
  GpMatrix<P> by_to = GpMatrix<P>::Zero();
};

template <int P>
LocalState<P> local_state(const GpState<P>& from, const GpState<P>& to) {
  LocalState<P> out;
  const Twist xi = log_se3(from.pose.inverse() * to.pose);
  const Matrix6 J = inverse_right_jacobian_se3(xi);
  const Matrix6 by_from_pose = -inverse_left_jacobian_se3(xi);
  const Twist& w = to.rates[0];
  const Twist rate = J * w;
  const Matrix6 G = body_rate_jacobian(xi, w);
  out.value[0] = xi;
  out.value[1] = rate;
  out.by_from.template block<6, 6>(0, 0) = by_from_pose;
  out.by_from.template block<6, 6>(6, 0) = G * by_from_pose;
  out.by_to.template block<6, 6>(0, 0) = J;
  out.by_to.template block<6, 6>(6, 0) = G * J;
  out.by_to.template block<6, 6>(6, 6) = J;
  if constexpr (P == 3) {
    const Twist& a = to.rates[1];
    const Matrix6 W = small_adjoint(w);
    const Matrix6 by_xi = body_rate_jacobian(xi, a) - 0.5 * W * G;
    out.value[2] = J * a - 0.5 * W * rate;
    out.by_from.template block<6, 6>(12, 0) = by_xi * by_from_pose;
    out.by_to.template block<6, 6>(12, 0) = by_xi * J;
    out.by_to.template block<6, 6>(12, 6) = 0.5 * (small_adjoint(rate) - W * J);
    out.by_to.template block<6, 6>(12, 12) = J;
  }
  return out;
}

/// error = W (local state of `to` - Phi(h) local state of `from`), where W' W is the inverse
/// covariance for unit power. The error is white up to the power of the noise, which differs
/// between rows 0..2 and 3..5 of each six.
template <int P>
struct Link {
  GpVector<P> error;
  GpMatrix<P> by_from, by_to;
};

template <int P>
Link<P> link(const GpState<P>& from, const GpState<P>& to, double h) {
  static const typename Prior<P>::Small unit_root = Prior<P>::root();
  const LocalState<P> local = local_state(from, to);
  Link<P> raw;
  raw.by_from = local.by_from;
  raw.by_to = local.by_to;
  for (int a = 0; a < P; ++a) {
    raw.error.template segment<6>(6 * a) = local.value[static_cast<std::size_t>(a)];
    for (int b = std::max(a, 1); b < P; ++b) {
      const double phi = std::pow(h, b - a) / Prior<P>::factorial(b - a);
      raw.error.template segment<6>(6 * a) -= phi * from.rates[static_cast<std::size_t>(b - 1)];
      raw.by_from.template block<6, 6>(6 * a, 6 * b) -= phi * Matrix6::Identity();
    }
  }
  Link<P> out{GpVector<P>::Zero(), GpMatrix<P>::Zero(), GpMatrix<P>::Zero()};
  for (int a = 0; a < P; ++a) {
    for (int b = 0; b <= a; ++b) {
      const double weight = unit_root(a, b) * std::pow(h, b - P + 0.5);
      out.error.template segment<6>(6 * a) += weight * raw.error.template segment<6>(6 * b);
      out.by_from.template middleRows<6>(6 * a) +=
          weight * raw.by_from.template middleRows<6>(6 * b);
      out.by_to.template middleRows<6>(6 * a) += weight * raw.by_to.template middleRows<6>(6 * b);
    }
  }
  return out;
}

}  // namespace loopbench::methods
