#include "methods/smoothers/trend_filter.hpp"

#include <gtest/gtest.h>

#include "datasets/core/polyline.hpp"
#include "methods/smoothers/penalised/trend.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/noisy_paths.hpp"

namespace loopbench::trend_filter_test {

using namespace methods;

namespace {

using namespace test;

/// Forward motion, a stop, sideways motion, then with rotation: kinks at 12, 20 and 29 of 40.
Trajectory stop_and_go() {
  Trajectory out;
  Vector3 position(1.0, 2.0, 0.0);
  double angle = 0.0, time = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    out.push_back({time, turned_about_z(angle, position)});
    const double step = i % 3 == 0 ? 0.2 : 0.5;
    time += step;
    if (i < 12) position += step * Vector3(1.0, 0.0, 0.1);
    if (i >= 20) position += step * Vector3(0.0, -0.7, 0.0);
    if (i >= 29) angle += 0.4 * step;
  }
  return out;
}

TEST(TrendFilter, RecoversPiecewiseLinearMotion) {
  const Trajectory truth = stop_and_go();
  Report report;
  const auto curve = smooth<TrendFilter>(truth, {{"refit", true}}, &report);
  EXPECT_TRUE(report.notes.empty());
  EXPECT_EQ(count(report, "kinks_t"), 2.0);
  EXPECT_EQ(count(report, "kinks_r"), 1.0);
  for (const auto& [stamp, pose] : truth) {
    EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-9, 1e-9)) << stamp;
  }
}

TEST(TrendFilter, FindsTheKinksUnderNoiseAndReducesTheError) {
  double before = 0.0, after = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Trajectory truth = stop_and_go();
    const Trajectory keyframes = with_white_noise(truth, 0.02, seed);
    Report report;
    const auto curve = smooth<TrendFilter>(keyframes, {{"refit", true}}, &report);
    before += rms_error(Polyline(keyframes), truth);
    after += rms_error(*curve, truth);
    EXPECT_LE(count(report, "kinks_t"), 8.0);
  }
  EXPECT_LT(after, 0.6 * before);
}

TEST(TrendFilter, ReducesNoiseOnACurvedPath) {
  double before = 0.0, after = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Trajectory truth = hand_held_truth(120);
    const Trajectory keyframes = with_white_noise(truth, 0.02, seed);
    Report report;
    before += rms_error(Polyline(keyframes), truth);
    after += rms_error(*smooth<TrendFilter>(keyframes, {}, &report), truth);
    EXPECT_TRUE(report.notes.empty());
  }
  EXPECT_LT(after, 0.9 * before);
}

TEST(TrendFilter, KinkOfThreePointsIsSoftThresholded) {
  // y = (0, 1, 0), unit steps: D = (1, -2, 1), D y = -2, D D' = 6. The fit is the line for lambda
  // >= 2 / 6; below, x = y + lambda D' = (lambda, 1 - 2 lambda, lambda).
  const Trend trend({0.0, 1.0, 2.0});
  const std::vector<Vector3> y{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  EXPECT_NEAR(trend.min_lambda_of_line(y), 1.0 / 3.0, 1e-15);
  for (const double lambda : {0.05, 0.2, 0.5}) {
    const auto fit = trend.fit(y, lambda, 1e-10);
    const double expected = std::min(lambda, 1.0 / 3.0);
    EXPECT_TRUE(fit.converged);
    EXPECT_NEAR(fit.values[0].x(), expected, 1e-8);
    EXPECT_NEAR(fit.values[1].x(), 1.0 - 2.0 * expected, 1e-8);
    EXPECT_EQ(fit.kinks.size(), lambda < 1.0 / 3.0 ? 1u : 0u);
  }
  EXPECT_NEAR(trend.refitted(y, {})[1].x(), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(trend.refitted(y, {1})[1].x(), 1.0, 1e-15);
}

TEST(TrendFilter, SatisfiesTheOptimalityConditions) {
  // y - x = D' v with |v_j| <= lambda, and v_j = lambda z_j / |z_j| where z = D x is nonzero.
  const std::vector<Vector3> y = wavy(kTwelve);
  const Trend trend(kTwelve);
  const double lambda = 0.2 * trend.min_lambda_of_line(y);
  const auto fit = trend.fit(y, lambda, 1e-11);
  ASSERT_TRUE(fit.converged);
  std::vector<double> times = kTwelve;
  for (double& time : times) time /= trend.interval();
  const SlopeChange D(times);
  std::vector<Vector3> residual = y;
  for (std::size_t i = 0; i < 12; ++i) residual[i] -= fit.values[i];
  std::vector<Vector3> v = D.of(residual);
  PentadiagonalFactor(D.outer()).solve(v);
  const std::vector<Vector3> slope_changes = D.of(fit.values);
  for (std::size_t j = 0; j < v.size(); ++j) {
    EXPECT_LE(v[j].norm(), lambda * (1.0 + 1e-6));
    const bool kink = std::ranges::find(fit.kinks, j + 1) != fit.kinks.end();
    if (kink) {
      EXPECT_LT((v[j] - lambda * slope_changes[j].normalized()).norm(), 1e-5 * lambda);
    }
  }
  EXPECT_GT(fit.kinks.size(), 0u);
  EXPECT_LT(fit.kinks.size(), 10u);
}

}  // namespace
}  // namespace loopbench::trend_filter_test
