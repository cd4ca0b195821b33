// Parts of gp_wnoa: body rates, the prior between two states, its Jacobians.
#include <gtest/gtest.h>

#include <random>

#include "methods/smoothers/gp/link.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::gp_links_test {

using namespace methods;

namespace {

using namespace test;

TEST(BodyRate, SeriesEqualsTheInverseRightJacobian) {
  std::mt19937_64 random(1);
  // The series is replaced by the closed form at 1.414.
  for (const double angle : {0.0, 1e-8, 1e-3, 0.3, 1.4, 1.414, 1.415, 2.0, 3.1}) {
    Twist xi = random_twist(random, 2.0, 1.0);
    xi.tail<3>() *= angle / xi.tail<3>().norm();
    const BodyRateTerms c(xi.tail<3>().squaredNorm());
    const Matrix6 ad = small_adjoint(xi);
    const Matrix6 J = Matrix6::Identity() + 0.5 * ad + c.c2 * ad * ad + c.c4 * ad * ad * ad * ad;
    EXPECT_NEAR((J - inverse_right_jacobian_se3(xi)).norm(), 0.0, 1e-11) << angle;
  }
}

TEST(BodyRate, DerivativeAgreesWithDifferences) {
  std::mt19937_64 random(2);
  for (const double angle : {0.0, 1e-3, 0.3, 1.4, 1.43, 2.5, 3.1}) {
    Twist xi = random_twist(random, 2.0, 1.0);
    xi.tail<3>() *= angle / xi.tail<3>().norm();
    const Twist v = random_twist(random, 1.0, 1.0);
    const Matrix6 analytic = body_rate_jacobian(xi, v);
    constexpr double step = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Twist d = step * Twist::Unit(k);
      const Twist numeric =
          (inverse_right_jacobian_se3(xi + d) * v - inverse_right_jacobian_se3(xi - d) * v) /
          (2.0 * step);
      EXPECT_NEAR((numeric - analytic.col(k)).norm(), 0.0, 1e-8) << angle << ", " << k;
    }
  }
}

GpState random_state(std::mt19937_64& random) {
  GpState out;
  out.pose = exp_se3(random_twist(random, 1.0, 0.8));
  out.rate = random_twist(random, 1.0, 0.5);
  return out;
}

GpState moved(GpState state, const GpVector& by) {
  state.pose = state.pose * exp_se3(by.head<6>());
  state.rate += by.tail<6>();
  return state;
}

TEST(Link, JacobiansAgreeWithDifferences) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const GpState from = random_state(random), to = random_state(random);
    const Link analytic = link(from, to, 1.7);
    constexpr double step = 1e-6;
    for (int k = 0; k < 12; ++k) {
      const GpVector d = step * GpVector::Unit(k);
      const GpVector by_from =
          (link(moved(from, d), to, 1.7).error - link(moved(from, -d), to, 1.7).error) /
          (2.0 * step);
      const GpVector by_to =
          (link(from, moved(to, d), 1.7).error - link(from, moved(to, -d), 1.7).error) /
          (2.0 * step);
      const double size = analytic.by_from.norm();
      EXPECT_NEAR((by_from - analytic.by_from.col(k)).norm(), 0.0, 1e-8 * size) << k;
      EXPECT_NEAR((by_to - analytic.by_to.col(k)).norm(), 0.0, 1e-8 * size) << k;
    }
  }
}

TEST(Link, IsWhiteForUnitPower) {
  // Without rotation the error is linear: the covariance of W e must be the identity for e ~ Q(h).
  const double h = 1.7;
  Eigen::Matrix2d Q;  // textbook covariance for constant velocity
  Q << std::pow(h, 3) / 3, h * h / 2, h * h / 2, h;
  Eigen::Matrix2d W;
  GpState from;
  from.rate.setZero();
  for (int b = 0; b < 2; ++b) {
    GpVector d = GpVector::Zero();
    d[6 * b] = 1.0;
    const GpVector error = link(from, moved(from, d), h).error;
    for (int a = 0; a < 2; ++a) W(a, b) = error[6 * a];
  }
  EXPECT_NEAR((W * Q * W.transpose() - Eigen::Matrix2d::Identity()).norm(), 0.0, 1e-12);
}

TEST(Prior, BetweenTwoStatesConstantVelocityIsTheHermiteCubic) {
  for (const double s : {0.0, 0.2, 0.7, 1.0}) {
    const auto weights = Prior::between(s);
    EXPECT_NEAR(weights.from[0], 1.0 - 3.0 * s * s + 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.from[1], s - 2.0 * s * s + s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[0], 3.0 * s * s - 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[1], s * s * s - s * s, 1e-14);
  }
}

}  // namespace
}  // namespace loopbench::gp_links_test
