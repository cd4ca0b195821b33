#include "methods/smoothers/manifold/dm.hpp"

#include <gtest/gtest.h>

#include "datasets/core/interpolate.hpp"
#include "manifold_paths.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::dm_test {
namespace {

Dm::Options planar(int N) { return {.planar = N}; }
Dm::Options spatial(int M) { return {.planar = 0, .spatial = M}; }

std::unique_ptr<const Curve> smoothed(const Problem& problem, const Dm::Options& options) {
  Report report;
  return Dm(options).smooth(problem, report);
}

double counted(const Problem& problem, const Dm::Options& options, const std::string& name) {
  Report report;
  Dm(options).smooth(problem, report);
  return test::count(report, name);
}

Vector3 position(const Curve& curve, double time) { return curve.at(time).translation; }

class EveryVariant : public testing::TestWithParam<Dm::Options> {};
INSTANTIATE_TEST_SUITE_P(Dm,
                         EveryVariant,
                         testing::Values(planar(0),
                                         planar(3),
                                         planar(4),
                                         planar(5),
                                         spatial(6),
                                         spatial(7),
                                         spatial(8),
                                         Dm::Options{.planar = 4, .spatial = 6},
                                         Dm::Options{.planar = 5, .spatial = 8}));

TEST_P(EveryVariant, IsTwiceContinuouslyDifferentiable) {
  const Problem problem = keyframes_only(wandering(60, 5));
  EXPECT_NEAR(counted(problem, GetParam(), "jump_velocity"), 0.0, 1e-7);
  EXPECT_NEAR(counted(problem, GetParam(), "jump_acceleration"), 0.0, 1e-6);
  expect_motion_is_the_derivative(*smoothed(problem, GetParam()));
}

TEST_P(EveryVariant, KeepsTheOrientation) {
  const Trajectory keyframes = wandering(25, 9);
  const auto curve = smoothed(keyframes_only(keyframes), GetParam());
  for (std::size_t i = 0; i + 1 < keyframes.size(); ++i) {
    const auto& [stamp, pose] = keyframes[i];
    EXPECT_NEAR(angle_between(curve->at(stamp).rotation, pose.rotation), 0.0, 1e-12);
    const double middle = 0.5 * (stamp + keyframes[i + 1].stamp);
    const Rotation expected = slerp(pose.rotation, keyframes[i + 1].world_from_body.rotation, 0.5);
    EXPECT_NEAR(angle_between(curve->at(middle).rotation, expected), 0.0, 1e-9);
  }
}

TEST_P(EveryVariant, HandlesFewKeyframesRestAndPureRotation) {
  for (std::size_t count = 1; count <= 9; ++count) {
    const Trajectory keyframes = wandering(count, 11);
    const auto curve = smoothed(keyframes_only(keyframes), GetParam());
    EXPECT_EQ(curve->start(), keyframes.front().stamp);
    EXPECT_LT(
        (position(*curve, curve->end()) - keyframes.back().world_from_body.translation).norm(),
        0.05);
  }
  Trajectory spin = through(std::vector<Vector3>(12, Vector3(1e5, 2, 3)));
  for (StampedPose& pose : spin) pose.world_from_body.rotation = exp_so3({0, 0, 0.5 * pose.stamp});
  const auto curve = smoothed(keyframes_only(spin), GetParam());
  for (const double t : times_over(spin, 50)) EXPECT_EQ(position(*curve, t), Vector3(1e5, 2, 3));
}

TEST(Dm, LeastSquaresFamiliesMoveKeyframes) {
  const Trajectory keyframes = wandering(60, 2);
  double moved = 0.0;
  const auto curve = smoothed(keyframes_only(keyframes), planar(5));
  for (const auto& [stamp, pose] : keyframes) {
    moved = std::max(moved, (position(*curve, stamp) - pose.translation).norm());
  }
  EXPECT_GT(moved, 1e-4);
  EXPECT_LT(moved, 0.05);
}

// A single window: its chord lies along x, so its frame equals the world's up to sign.
void expect_on_curve(int N, const std::vector<double>& xs, double (*y)(double)) {
  std::vector<Vector3> points;
  for (const double x : xs) points.push_back({x, y(x), 0.0});
  const auto curve = smoothed(keyframes_only(through(points)), planar(N));
  for (double t = 0.0; t <= static_cast<double>(xs.size() - 1); t += 0.05) {
    const Vector3 p = position(*curve, t);
    EXPECT_NEAR(p.y(), y(p.x()), 1e-9);
  }
}

TEST(Dm, StaysOnAParabolaAndOnACubicBetweenKeyframes) {
  expect_on_curve(3, {-1.0, 0.2, 1.0}, [](double x) { return 0.4 * (1.0 - x * x); });
  expect_on_curve(4, {-1.0, -0.4, 0.5, 1.0}, [](double x) { return 0.5 * (x - x * x * x); });
}

TEST(Dm, StaysOnAQuadricBetweenKeyframes) {
  // All windows have z' = up, and a quadric in one level frame is a quadric in all of them.
  const auto height = [](const Vector3& p) {
    return 0.5 + 0.1 * p.x() * p.x() - 0.2 * p.x() * p.y() + 0.05 * p.y() * p.y() - 0.3 * p.y();
  };
  const std::vector<double> x{0, 1, 1.8, 1.5, 0.4, 1, 1.6, 2.5, 2.6, 1.4, 1.7};
  const std::vector<double> y{0, 0.2, 1, 2, 1.7, 1, 0.3, 0.9, 2, 2.3, 1.4};
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.push_back({x[i], y[i], height({x[i], y[i], 0.0})});
  }
  const Problem problem = keyframes_only(through(points));
  Dm::Options options = spatial(6);
  options.up = manifold::UpDirection::world_z;
  options.segment = {10.0, 3.2};  // one segment
  EXPECT_EQ(counted(problem, options, "spatial_windows"), 2.0);
  EXPECT_EQ(counted(problem, options, "spatial_truncated"), 0.0);  // in general position
  const auto curve = smoothed(problem, options);
  for (const double t : times_over(problem.keyframes, 700)) {
    const Vector3 p = position(*curve, t);
    EXPECT_NEAR(p.z(), height(p), 1e-9);
  }
}

TEST(Dm, GuardSplitsAHairpinAndCountsIt) {
  // The window 0..3 reverses at node 2: after splitting, 0..2 is a graph and 1..3 is not.
  const Problem problem = keyframes_only(through(
      {{0, 0, 0}, {1, 0, 0}, {2, 0.2, 0}, {1, 0.4, 0}, {0, 0.4, 0}, {-1, 0.4, 0}, {-2, 0.4, 0}}));
  Dm::Options options = planar(4);
  options.segment = {10.0, 3.2};  // one segment
  EXPECT_EQ(counted(problem, options, "segments"), 1.0);
  EXPECT_EQ(counted(problem, options, "split_windows"), 1.0);
  EXPECT_EQ(counted(problem, options, "fallbacks"), 1.0);
  EXPECT_EQ(counted(problem, options, "windows"), 3.0);
  for (const auto fallback : {manifold::Fallback::arc, manifold::Fallback::spline}) {
    options.fallback = fallback;
    const auto curve = smoothed(problem, options);
    for (const double t : times_over(problem.keyframes, 200)) {
      EXPECT_LT(std::abs(position(*curve, t).y() - 0.2), 0.4) << t;
      EXPECT_LT(position(*curve, t).x(), 2.3) << t;
    }
    for (const auto& [stamp, pose] : problem.keyframes) {
      EXPECT_NEAR((position(*curve, stamp) - pose.translation).norm(), 0.0, 1e-9);
    }
  }
}

TEST(Dm, RejectsASurfaceThatLeavesTheHeightRangeAndCountsIt) {
  // Nodes nearly on a circle, heights of +-1 cm: between them the quadric exceeds the height range.
  std::vector<Vector3> points;
  for (int i = 0; i < 6; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    const double radius = 1.0 + 0.02 * sign;
    points.push_back({radius * std::cos(0.9 * i), radius * std::sin(0.9 * i), 0.01 * sign});
  }
  const Problem problem = keyframes_only(through(points));
  Dm::Options options = spatial(6);
  options.up = manifold::UpDirection::world_z;
  options.segment = {10.0, 3.2};  // one segment
  const auto highest = [&] {
    const auto curve = smoothed(problem, options);
    double out = 0.0;
    for (const double t : times_over(problem.keyframes, 500)) {
      out = std::max(out, std::abs(position(*curve, t).z()));
    }
    return out;
  };
  EXPECT_EQ(counted(problem, options, "spatial_fallbacks"), 1.0);
  EXPECT_LT(highest(), 0.015);
  options.height_guard = false;
  EXPECT_EQ(counted(problem, options, "spatial_fallbacks"), 0.0);
  EXPECT_GT(highest(), 0.02);
}

TEST(Dm, CountsFallbacks) {
  const Problem still = keyframes_only(through(std::vector<Vector3>(7, Vector3(1, 2, 3))));
  EXPECT_EQ(counted(still, planar(3), "windows"), 3.0);
  EXPECT_EQ(counted(still, planar(3), "fallbacks"), 3.0);
  EXPECT_EQ(counted(still, spatial(6), "spatial_fallbacks"), 2.0);
  EXPECT_EQ(counted(keyframes_only(wandering(2, 1)), planar(4), "fallbacks"), 1.0);
  EXPECT_EQ(counted(keyframes_only(wandering(5, 1)), spatial(6), "spatial_fallbacks"), 1.0);
}

TEST(Dm, RejectsOtherWindowSizes) {
  EXPECT_EQ(with(Dm::Options{}, {{"planar", std::int64_t{5}}}).planar, 5);
  EXPECT_THROW(with(Dm::Options{}, {{"planar", std::int64_t{2}}}), OptionError);
  EXPECT_THROW(with(Dm::Options{}, {{"spatial", std::int64_t{5}}}), OptionError);
  EXPECT_THROW(with(Dm::Options{}, {{"speed_band", 0.0}}), OptionError);
  EXPECT_FALSE(with(Dm::Options{}, {{"speed_band", std::string("none")}}).segment.speed_band);
}

}  // namespace
}  // namespace loopbench::test::dm_test
