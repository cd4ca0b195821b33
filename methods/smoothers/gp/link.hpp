/// Prior residual between two neighbouring states, and its Jacobians.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "datasets/core/se3.hpp"

namespace loopbench::methods {

/// Adjoint of the Lie algebra: [a, b] = small_adjoint(a) b.
inline Matrix6 small_adjoint(const Twist& a) {
  Matrix6 out = Matrix6::Zero();
  out.topLeftCorner<3, 3>() = hat(a.tail<3>());
  out.topRightCorner<3, 3>() = hat(a.head<3>());
  out.bottomRightCorner<3, 3>() = hat(a.tail<3>());
  return out;
}

/// J_r^-1(xi) = I + ad / 2 + c2 ad^2 + c4 ad^4 with ad = small_adjoint(xi): the closed form of the
/// series f(ad) = sum of B_n (-ad)^n / n! with Bernoulli numbers B_n, where f(z) = z / (1 - e^-z)
/// (Barfoot, State Estimation for Robotics, chapter 7). ad has the eigenvalues 0 and +-i phi, each
/// with multiplicity two, so a polynomial with the values and first derivatives of f there equals
/// f(ad). With s = phi^2 and C = (phi / 2) cot(phi / 2), f(i phi) = C + i phi / 2, so
///
///     -s c2 + s^2 c4 = C - 1,   -c2 + 2 s c4 = dC/ds.
struct BodyRateTerms {
  double c2, c4, c2_by_s, c4_by_s;  ///< and their derivatives with respect to s

  /// Requires s < (2 pi)^2.
  explicit BodyRateTerms(double s) {
    const double phi = std::sqrt(s);
    if (s < 2.0) {
      // C = 1 - 2 sum zeta(2 n) (s / 4 pi^2)^n = 1 + sum b_n s^n (Abramowitz and Stegun, 4.3.70
      // with 23.2.16), and by the two equations above c2 = sum (n - 2) b_n s^(n - 1) and c4 = sum
      // (n - 1) b_n s^(n - 2). The twelfth term is below 1e-15 of the first.
      constexpr double kZeta[] = {1.6449340668482264,
                                  1.0823232337111382,
                                  1.0173430619844491,
                                  1.0040773561979443,
                                  1.0009945751278181,
                                  1.0002460865533080,
                                  1.0000612481350587,
                                  1.0000152822594086,
                                  1.0000038172932650,
                                  1.0000009539620339,
                                  1.0000002384505027,
                                  1.0000000596081891};
      constexpr double kRound = 4.0 * std::numbers::pi * std::numbers::pi;
      c2 = c4 = c2_by_s = c4_by_s = 0.0;
      for (int n = 12; n >= 1; --n) {
        const double b = -2.0 * kZeta[n - 1] * std::pow(kRound, -n);
        c2 += (n - 2) * b * std::pow(s, n - 1);
        if (n >= 2) c4 += (n - 1) * b * std::pow(s, n - 2);
        if (n >= 2) c2_by_s += (n - 2) * (n - 1) * b * std::pow(s, n - 2);
        if (n >= 3) c4_by_s += (n - 1) * (n - 2) * b * std::pow(s, n - 3);
      }
      return;
    }
    const double cot = 1.0 / std::tan(0.5 * phi);
    const double csc2 = 1.0 + cot * cot;
    const double C = 0.5 * phi * cot;
    const double by_s = 0.25 * cot / phi - 0.125 * csc2;
    const double by_s_twice =
        (-0.125 * csc2 / phi - 0.25 * cot / s + 0.125 * csc2 * cot) / (2.0 * phi);
    c4 = (1.0 + s * by_s - C) / (s * s);
    c2 = 2.0 * s * c4 - by_s;
    c4_by_s = (by_s_twice - 2.0 * c4) / s;
    c2_by_s = 2.0 * c4 + 2.0 * s * c4_by_s - by_s_twice;
  }
};

/// Derivative of J_r^-1(xi) v with respect to xi, for constant v.
inline Matrix6 body_rate_jacobian(const Twist& xi, const Twist& v) {
  const BodyRateTerms c(xi.tail<3>().squaredNorm());
  const Matrix6 ad = small_adjoint(xi);
  const Matrix6 ad2 = ad * ad;
  const Twist v1 = ad * v, v2 = ad * v1, v3 = ad * v2, v4 = ad * v3;
  // ad(d) w = -ad(w) d, applied to each factor ad.
  const Matrix6 V = small_adjoint(v), V1 = small_adjoint(v1);
  const Matrix6 V2 = small_adjoint(v2), V3 = small_adjoint(v3);
  Matrix6 out = -0.5 * V - c.c2 * (V1 + ad * V) - c.c4 * (V3 + ad * V2 + ad2 * (V1 + ad * V));
  out.rightCols<3>() += 2.0 * (c.c2_by_s * v2 + c.c4_by_s * v4) * xi.tail<3>().transpose();
  return out;
}

/// One scalar axis with state (x, x') over a unit interval. Over h seconds, derivative a scales by
/// h^-a and the covariance by h^3. Source: Barfoot, State Estimation for Robotics, 3.4; Anderson &
/// Barfoot 2015.
struct Prior {
  using Small = Eigen::Matrix2d;

  static Small transition(double s) {
    Small out;
    out << 1.0, s, 0.0, 1.0;
    return out;
  }

  /// int_0^s Phi(s - r) e e' Phi(s - r)' dr, where e is the last unit vector.
  static Small covariance(double s) {
    Small out;
    out << std::pow(s, 3) / 3.0, std::pow(s, 2) / 2.0, std::pow(s, 2) / 2.0, s;
    return out;
  }

  /// Returns the W with W' W = covariance(1)^-1.
  static Small root() {
    const Small lower = covariance(1.0).llt().matrixL();
    return lower.triangularView<Eigen::Lower>().solve(Small::Identity());
  }

  /// Weights of the states at 0 and 1 in the posterior mean of x(s).
  struct Weights {
    Eigen::RowVector2d from, to;
  };
  static Weights between(double s) {
    static const Small inverse = covariance(1.0).inverse();
    const Small psi = covariance(s) * transition(1.0 - s).transpose() * inverse;
    const Small lambda = transition(s) - psi * transition(1.0);
    return {lambda.row(0), psi.row(0)};
  }
};

/// Pose and body twist per unit of time. The pose is perturbed by Exp(d) on the right.
struct GpState {
  Pose pose;
  Twist rate;
};

using GpVector = Eigen::Matrix<double, 12, 1>;
using GpMatrix = Eigen::Matrix<double, 12, 12>;

/// Local coordinates of state j relative to state i: xi(t) = Log(T_i^-1 T(t)) and its derivative at
/// j. They are xi and J_r^-1(xi) w_j. At state i they are 0 and w_i.
struct LocalState {
  std::array<Twist, 2> value;  ///< local coordinates of j
  GpMatrix by_from = GpMatrix::Zero();
  GpMatrix by_to = GpMatrix::Zero();
};

inline LocalState local_state(const GpState& from, const GpState& to) {
  LocalState out;
  const Twist xi = log_se3(from.pose.inverse() * to.pose);
  const Matrix6 J = inverse_right_jacobian_se3(xi);
  const Matrix6 by_from_pose = -inverse_left_jacobian_se3(xi);
  const Twist& w = to.rate;
  const Matrix6 G = body_rate_jacobian(xi, w);
  out.value[0] = xi;
  out.value[1] = J * w;
  out.by_from.block<6, 6>(0, 0) = by_from_pose;
  out.by_from.block<6, 6>(6, 0) = G * by_from_pose;
  out.by_to.block<6, 6>(0, 0) = J;
  out.by_to.block<6, 6>(6, 0) = G * J;
  out.by_to.block<6, 6>(6, 6) = J;
  return out;
}

/// error = W (local state of `to` - Phi(h) local state of `from`), where W' W is the inverse
/// covariance for unit power. The error is white up to the power of the noise, which differs
/// between rows 0..2 and 3..5 of each six.
struct Link {
  GpVector error;
  GpMatrix by_from, by_to;
};

inline Link link(const GpState& from, const GpState& to, double h) {
  static const Prior::Small unit_root = Prior::root();
  const LocalState local = local_state(from, to);
  Link raw;
  raw.by_from = local.by_from;
  raw.by_to = local.by_to;
  raw.error.head<6>() = local.value[0];
  raw.error.head<6>() -= h * from.rate;
  raw.by_from.block<6, 6>(0, 6) -= h * Matrix6::Identity();
  raw.error.tail<6>() = local.value[1];
  raw.error.tail<6>() -= from.rate;
  raw.by_from.block<6, 6>(6, 6) -= Matrix6::Identity();
  Link out{GpVector::Zero(), GpMatrix::Zero(), GpMatrix::Zero()};
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b <= a; ++b) {
      const double weight = unit_root(a, b) * std::pow(h, b - 1.5);
      out.error.segment<6>(6 * a) += weight * raw.error.segment<6>(6 * b);
      out.by_from.middleRows<6>(6 * a) += weight * raw.by_from.middleRows<6>(6 * b);
      out.by_to.middleRows<6>(6 * a) += weight * raw.by_to.middleRows<6>(6 * b);
    }
  }
  return out;
}

}  // namespace loopbench::methods
