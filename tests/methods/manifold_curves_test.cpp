#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/core/fields.hpp"
#include "methods/smoothers/manifold/planar.hpp"

namespace loopbench::methods::manifold::manifold_curves_test {
namespace {

template <class Function>
std::vector<Vector2> along_x(const std::vector<double>& xs, Function y) {
  std::vector<Vector2> out;
  for (const double x : xs) out.push_back({x, y(x)});
  return out;
}
const std::vector<double> kFive{0.0, 0.3, 0.7, 1.1, 1.6};

TEST(LevenbergMarquardt, FindsTheValleyOfRosenbrock) {
  Parameters start(2);
  start << -1.2, 1.0;
  const Parameters best = levenberg_marquardt(start, 2, [](const auto& p, auto& r, auto& J) {
    r << 10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0];
    J << -20.0 * p[0], 10.0, -1.0, 0.0;
  });
  EXPECT_NEAR(best[0], 1.0, 1e-9);
  EXPECT_NEAR(best[1], 1.0, 1e-9);
}

TEST(Sine, RecoversAmplitudeRateAndPhase) {
  const auto f = fit_sine(along_x(kFive, [](double x) { return 0.3 * std::sin(2 * x + 0.4); }));
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->amplitude, 0.3, 1e-7);
  EXPECT_NEAR(f->rate, 2.0, 1e-6);
  EXPECT_NEAR(f->phase, 0.4, 1e-6);
}

TEST(Sine, RejectsAnAlias) {
  // Alternating nodes: the only sine through them has a wavelength of two spacings.
  const std::vector<Vector2> zigzag{{0, 1}, {1, -1}, {2, 1}, {3, -1}, {4, 1}, {5, -1}};
  const auto f = fit_sine(zigzag);
  if (f) {
    EXPECT_GE(2.0 * std::numbers::pi / f->rate, 4.0 * (1.0 - 1e-9));
    EXPECT_LE(f->amplitude, 4.0);
  }
  // The article's example: a = 2.007, b = 104.6 with 9 cm between keyframes.
  const auto printed = [](double x) { return 2.007 * std::sin(104.6 * x - 32.08); };
  const auto g = fit_sine(along_x({0.0, 0.09, 0.18, 0.27, 0.36}, printed));
  if (g) {
    EXPECT_LT(g->rate, 2.0 * std::numbers::pi / (4.0 * 0.09) * (1.0 + 1e-6));
  }
}

TEST(Sine, RejectsAnAmplitudeFarAboveItsPoints) {
  // Part of a parabola: a long wave of large amplitude fits best.
  const auto f = fit_sine(along_x(kFive, [](double x) { return 2 + 0.01 * x * x; }));
  EXPECT_FALSE(f);
}

TEST(Rational, RecoversItsCoefficients) {
  const auto f =
      fit_rational(along_x(kFive, [](double x) { return 1.3 / (x * x + 0.5 * x + 2.0); }));
  ASSERT_TRUE(f);
  for (const double x : {-0.5, 0.5, 2.0}) {
    EXPECT_NEAR((*f)(x), 1.3 / (x * x + 0.5 * x + 2.0), 1e-8);
  }
}

TEST(Rational, RejectsAPoleBetweenTheNodesAndBesideThem) {
  const auto with_pole_at = [](double pole) {
    return fit_rational(along_x({0.0, 0.4, 0.7, 1.1, 1.6},
                                [&](double x) { return 1.0 / ((x - pole) * (x + 9.0)); }));
  };
  EXPECT_FALSE(with_pole_at(0.55));
  EXPECT_FALSE(with_pole_at(1.9));
  EXPECT_TRUE(with_pole_at(4.0));
}

TEST(Hyperbola, RecoversItsPoleAndRejectsItAmongTheNodes) {
  const auto f = fit_hyperbola(along_x(kFive, [](double x) { return 1.3 + 0.5 / (x + 2.0); }));
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->c0, 1.3, 1e-7);
  EXPECT_NEAR(f->pole, -2.0, 1e-6);
  EXPECT_NEAR((*f)(0.5), 1.5, 1e-7);
  const auto g = fit_hyperbola(along_x(kFive, [](double x) { return 1.0 / (x - 0.5); }));
  if (g) {
    EXPECT_TRUE(g->pole < -0.5 || g->pole > 2.0);
  }
}

TEST(Implicit, RecoversACircleFromFivePointsAndFromMore) {
  for (const int count : {5, 6, 9}) {
    std::vector<Vector2> points;
    for (int i = 0; i < count; ++i) {
      points.push_back({1.0 + 2.0 * std::cos(0.4 * i), 3.0 + 2.0 * std::sin(0.4 * i)});
    }
    const auto f = fit_implicit(points);
    ASSERT_TRUE(f);
    const auto on = f->nearest(2.5, 5.0);
    ASSERT_TRUE(on);
    EXPECT_NEAR(std::hypot(on->first - 1.0, on->second - 3.0), 2.0, 1e-9);
    EXPECT_NEAR(f->alpha[2] / f->alpha[0], 1.0, 1e-6);  // x^2 + y^2, without x y
    EXPECT_NEAR(f->alpha[1] / f->alpha[0], 0.0, 1e-6);
  }
}

TEST(Implicit, JetsAgreeWithDifferences) {
  std::vector<Vector2> points;
  for (int i = 0; i < 7; ++i) points.push_back({std::cos(0.5 * i), std::sin(0.5 * i)});
  const auto f = fit_implicit(points);
  ASSERT_TRUE(f);
  const double h = 1e-4;
  const auto at = [&](double t) { return *f->nearest(0.8 + 0.3 * t, 1.1 - 0.5 * t * t); };
  const auto jet = *f->nearest(Jet<double>{0.8, 0.3, 0.0}, Jet<double>{1.1, 0.0, -1.0});
  EXPECT_NEAR(jet.first.first, (at(h).first - at(-h).first) / (2 * h), 1e-6);
  EXPECT_NEAR(jet.second.second, (at(h).second - 2 * at(0).second + at(-h).second) / (h * h), 1e-5);
}

TEST(Implicit, NeedsPointsWithAnExtent) {
  EXPECT_FALSE(fit_implicit(std::vector<Vector2>(4, Vector2(1, 2))));
  EXPECT_FALSE(fit_implicit(std::vector<Vector2>(7, Vector2(1, 2))));
}

TEST(Families, AreParsedByName) {
  EXPECT_EQ(read_families("poly2, sin1 line"),
            (std::vector{Family::poly2, Family::sin1, Family::line}));
  EXPECT_THROW(read_families("poly4"), OptionError);
  EXPECT_THROW(read_families(" "), OptionError);
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_curves_test
