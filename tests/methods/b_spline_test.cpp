// b_spline: its basis, the derivative of its rotation, the curve.
#include <gtest/gtest.h>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/spline/basis.hpp"
#include "methods/smoothers/spline/curve.hpp"
#include "tests/support/noisy_paths.hpp"

namespace loopbench::b_spline_test {

using namespace methods;

namespace {

using namespace test;

/// Position is a polynomial of the given degree, rotation a polynomial angle about one axis.
auto polynomial(int degree) {
  return [degree](double time) {
    const double s = 0.2 * (time - 1000.0);
    double power = 1.0;
    Vector3 position(1.0, -2.0, 0.5);
    double angle = 0.3;
    for (int k = 1; k <= degree; ++k) {
      power *= s;
      position += power * Vector3(0.5 / k, 0.3 - 0.2 * k, 0.1 * k);
      angle += 0.4 * power / k;
    }
    return Pose{exp_so3({0.2, 0.1, -0.7}) * exp_so3(angle * Vector3(1.0, -2.0, 2.0) / 3.0),
                position};
  };
}

TEST(SplineBasis, IsANonNegativePartitionOfUnityAndReproducesTime) {
  for (std::size_t order = 2; order <= 6; ++order) {
    const auto sites = uneven(9, 1000.0);
    const auto basis = SplineBasis::for_sites(order, sites);
    EXPECT_EQ(basis.size(), sites.size());
    const std::vector<double>& breaks = basis.breaks();
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
      for (const double u : {0.0, 0.3, 0.9, 1.0}) {
        const double time = breaks[piece] + u * (breaks[piece + 1] - breaks[piece]);
        const auto N = basis.values(piece, time);
        double sum = 0.0, mean = 0.0;
        for (std::size_t j = 0; j < order; ++j) {
          EXPECT_GE(N[j], -1e-12);
          sum += N[j];
          mean += N[j] * (basis.greville(piece + j) - 1000.0);
        }
        EXPECT_NEAR(sum, 1.0, 1e-13);
        EXPECT_NEAR(mean, time - 1000.0, 1e-12);
        EXPECT_NEAR(basis.cumulative(piece, time)[0], 1.0, 1e-13);
      }
    }
  }
}

TEST(RotationDerivative, AgreesWithDifferences) {
  const std::array<Rotation, 5> controls{exp_so3({0.1, 0.2, 0.3}),
                                         exp_so3({0.4, 0.0, 0.6}),
                                         exp_so3({0.5, -0.6, 0.9}),
                                         exp_so3({1.5, -0.6, 0.4}),
                                         exp_so3({1.2, -1.6, 0.0})};
  const SplineBasis::Values B{1.0, 0.95, 0.7, 0.3, 0.02, 0.0};
  const RotationDerivative current = rotation_derivative(controls.data(), 5, B);
  constexpr double step = 1e-6;
  for (std::size_t j = 0; j < 5; ++j) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double by) {
        auto moved_controls = controls;
        moved_controls[j] = exp_so3(by * Vector3::Unit(axis)) * moved_controls[j];
        return rotation_derivative(moved_controls.data(), 5, B).rotation;
      };
      const Vector3 numeric = log_so3(moved(step) * moved(-step).conjugate()) / (2.0 * step);
      EXPECT_NEAR((numeric - current.by[j].col(axis)).norm(), 0.0, 1e-8) << j << ", " << axis;
    }
  }
}

TEST(BSpline, PassesThroughTheKeyframesInEveryOrder) {
  for (const std::size_t n : {1u, 2u, 3u, 5u, 6u, 60u}) {
    Trajectory keyframes = hand_held_truth(n);
    for (int order = 2; order <= 6; ++order) {
      SCOPED_TRACE(order);
      const auto curve = smooth<BSplineThrough>(keyframes, {{"order", std::int64_t{order}}});
      expect_close(curve->sample(stamps(keyframes)), keyframes, 1e-11);
    }
  }
}

TEST(BSpline, OfOrderKReproducesPolynomialsOfDegreeKMinusOne) {
  for (int order = 2; order <= 6; ++order) {
    const auto truth = polynomial(order - 1);
    const Trajectory keyframes = sampled_at(uneven(14, 1000.0), truth);
    const auto curve = smooth<BSplineThrough>(keyframes, {{"order", std::int64_t{order}}});
    expect_follows(*curve, keyframes, truth, 1e-9);
  }
}

TEST(BSpline, OfOrderTwoIsThePolyline) {
  const Trajectory keyframes = hand_held_truth(20);
  const auto curve = smooth<BSplineThrough>(keyframes, {{"order", std::int64_t{2}}});
  const Polyline polyline(keyframes);
  expect_follows(
      *curve, keyframes, [&](double time) { return polyline.at(time); }, 1e-12);
}

}  // namespace
}  // namespace loopbench::b_spline_test
