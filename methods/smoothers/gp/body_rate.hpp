/// Inverse right Jacobian of SE(3) applied to a twist, and its derivative.
#pragma once

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

/// J_r^-1(xi) = I + ad / 2 + c2 ad^2 + c4 ad^4 with ad = small_adjoint(xi). The series is exact,
/// because ad has only the eigenvalues 0 and +-i phi, each with multiplicity two. c2 and c4 are
/// functions of s = phi^2.
struct BodyRateTerms {
  double c2, c4, c2_by_s, c4_by_s;

  /// Requires s < (2 pi)^2.
  explicit BodyRateTerms(double s) {
    const double phi = std::sqrt(s);
    if (s < 2.0) {
      // C = (phi / 2) cot(phi / 2) = 1 - 2 sum zeta(2 n) (s / 4 pi^2)^n. The twelfth term is below
      // 1e-15 of the first.
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

}  // namespace loopbench::methods
