/// Motion prior with white noise on the P-th derivative: P = 2 constant velocity, P = 3 constant
/// acceleration.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace loopbench::methods {

/// One scalar axis with state (x, x', ..) over a unit interval. Over h seconds, derivative a scales
/// by h^-a and the covariance by h^(2P-1). Source: Barfoot, State Estimation for Robotics, 3.4;
/// Anderson & Barfoot 2015 (P = 2), Tang, Yoon & Barfoot 2019 (P = 3).
template <int P>
struct Prior {
  using Small = Eigen::Matrix<double, P, P>;

  static double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

  static Small transition(double s) {
    Small out = Small::Zero();
    for (int a = 0; a < P; ++a) {
      for (int b = a; b < P; ++b) out(a, b) = std::pow(s, b - a) / factorial(b - a);
    }
    return out;
  }

  /// int_0^s Phi(s - r) e e' Phi(s - r)' dr, where e is the last unit vector.
  static Small covariance(double s) {
    Small out;
    for (int a = 0; a < P; ++a) {
      for (int b = 0; b < P; ++b) {
        const int left = P - 1 - a, right = P - 1 - b;
        out(a, b) = std::pow(s, left + right + 1) /
                    ((left + right + 1) * factorial(left) * factorial(right));
      }
    }
    return out;
  }

  /// Returns the W with W' W = covariance(1)^-1.
  static Small root() {
    const Small lower = covariance(1.0).llt().matrixL();
    return lower.template triangularView<Eigen::Lower>().solve(Small::Identity());
  }

  /// Weights of the states at 0 and 1 in the posterior mean of x(s).
  struct Weights {
    Eigen::Matrix<double, 1, P> from, to;
  };
  static Weights between(double s) {
    static const Small inverse = covariance(1.0).inverse();
    const Small psi = covariance(s) * transition(1.0 - s).transpose() * inverse;
    const Small lambda = transition(s) - psi * transition(1.0);
    return {lambda.row(0), psi.row(0)};
  }
};

}  // namespace loopbench::methods
