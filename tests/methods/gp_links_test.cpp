// Parts of gp_wnoa and gp_wnoj: body rates, the prior between two states, its Jacobians.
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
    EXPECT_LT((J - inverse_right_jacobian_se3(xi)).norm(), 1e-11) << angle;
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
      EXPECT_LT((numeric - analytic.col(k)).norm(), 1e-8) << angle << ", " << k;
    }
  }
}

template <int P>
GpState<P> random_state(std::mt19937_64& random) {
  GpState<P> out;
  out.pose = exp_se3(random_twist(random, 1.0, 0.8));
  for (Twist& rate : out.rates) rate = random_twist(random, 1.0, 0.5);
  return out;
}

template <int P>
GpState<P> moved(GpState<P> state, const GpVector<P>& by) {
  state.pose = state.pose * exp_se3(by.template head<6>());
  for (int a = 1; a < P; ++a) {
    state.rates[static_cast<std::size_t>(a - 1)] += by.template segment<6>(6 * a);
  }
  return state;
}

template <int P>
void expect_link_jacobians() {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const GpState<P> from = random_state<P>(random), to = random_state<P>(random);
    const Link<P> analytic = link<P>(from, to, 1.7);
    constexpr double step = 1e-6;
    for (int k = 0; k < 6 * P; ++k) {
      const GpVector<P> d = step * GpVector<P>::Unit(k);
      const GpVector<P> by_from =
          (link<P>(moved<P>(from, d), to, 1.7).error - link<P>(moved<P>(from, -d), to, 1.7).error) /
          (2.0 * step);
      const GpVector<P> by_to =
          (link<P>(from, moved<P>(to, d), 1.7).error - link<P>(from, moved<P>(to, -d), 1.7).error) /
          (2.0 * step);
      const double size = analytic.by_from.norm();
      EXPECT_LT((by_from - analytic.by_from.col(k)).norm(), 1e-8 * size) << k;
      EXPECT_LT((by_to - analytic.by_to.col(k)).norm(), 1e-8 * size) << k;
    }
  }
}

TEST(Link, JacobiansAgreeWithDifferences) {
  expect_link_jacobians<2>();
  expect_link_jacobians<3>();
}

TEST(Link, IsWhiteForUnitPower) {
  // Without rotation the error is linear: the covariance of W e must be the identity for e ~ Q(h).
  const double h = 1.7;
  Eigen::Matrix3d Q;  // textbook covariance for constant acceleration
  Q << std::pow(h, 5) / 20, std::pow(h, 4) / 8, std::pow(h, 3) / 6, std::pow(h, 4) / 8,
      std::pow(h, 3) / 3, h * h / 2, std::pow(h, 3) / 6, h * h / 2, h;
  Eigen::Matrix3d W;
  GpState<3> from;
  for (Twist& rate : from.rates) rate.setZero();
  for (int b = 0; b < 3; ++b) {
    GpVector<3> d = GpVector<3>::Zero();
    d[6 * b] = 1.0;
    const GpVector<3> error = link<3>(from, moved<3>(from, d), h).error;
    for (int a = 0; a < 3; ++a) W(a, b) = error[6 * a];
  }
  EXPECT_LT((W * Q * W.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Prior, BetweenTwoStatesConstantVelocityIsTheHermiteCubic) {
  for (const double s : {0.0, 0.2, 0.7, 1.0}) {
    const auto weights = Prior<2>::between(s);
    EXPECT_NEAR(weights.from[0], 1.0 - 3.0 * s * s + 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.from[1], s - 2.0 * s * s + s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[0], 3.0 * s * s - 2.0 * s * s * s, 1e-14);
    EXPECT_NEAR(weights.to[1], s * s * s - s * s, 1e-14);
    // With position, velocity and acceleration at both ends: the quintic.
    const auto quintic = Prior<3>::between(s);
    EXPECT_NEAR(quintic.to[0], s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), 1e-13);
  }
}

}  // namespace
}  // namespace loopbench::gp_links_test
