// Smoothers at time gaps, nearly coincident keyframes and large rotations: a chord is used there
// only.
#include <gtest/gtest.h>

#include "datasets/core/interpolate.hpp"
#include "datasets/core/median_interval.hpp"
#include "methods/smoothers/gaussian_process.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/runs/pose_runs.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::gaps_test {
namespace {

/// Two sequences of a hand-held camera, `gap` seconds apart.
Problem with_gap(double gap) {
  Problem out{.keyframes = hand_held_truth(40)};
  const double begin = out.keyframes.back().stamp + gap;
  for (const StampedPose& pose : hand_held_truth(40)) {
    out.keyframes.push_back(pose);
    out.keyframes.back().stamp += begin - out.keyframes.front().stamp;
  }
  return out;
}

/// Largest deviation from the straight line and from the great arc within interval `i` [m], [rad].
std::pair<double, double> chord_deviation(const Curve& curve,
                                          const Trajectory& poses,
                                          std::size_t i) {
  const auto& [begin, a] = poses[i];
  const auto& [end, b] = poses[i + 1];
  const Pose from = curve.at(begin), to = curve.at(end);
  std::pair<double, double> out{0.0, 0.0};
  for (int k = 1; k < 20; ++k) {
    const double u = k / 20.0;
    const Pose chord = interpolate(from, to, u);
    const Pose current = curve.at(std::lerp(begin, end, u));
    out.first = std::max(out.first, (current.translation - chord.translation).norm());
    out.second = std::max(out.second, angle_between(current.rotation, chord.rotation));
  }
  return out;
}

void expect_near_keyframes(const Curve& curve, const Trajectory& keyframes, double tolerance) {
  expect_close(curve.sample(stamps(keyframes)), keyframes, tolerance);
}

TEST(PoseRuns, AreSplitAtTheGivenIntervals) {
  EXPECT_EQ(runs_without_breaks(5, [](std::size_t i) { return i == 1 || i == 3; }),
            (std::vector<PoseRun>{{0, 1}, {2, 3}, {4, 4}}));
  EXPECT_EQ(runs_without_breaks(1, [](std::size_t) { return true; }),
            (std::vector<PoseRun>{{0, 0}}));
}

// A spline through two poses 1 us and 1 cm apart would move at 10 km/s there.
TEST(ShortInterval, IsBridgedByAChordInsteadOfOvershooting) {
  Problem problem{.keyframes = hand_held_truth(40)};
  StampedPose copy = problem.keyframes[20];
  copy.stamp += 1e-6;
  copy.world_from_body.translation.x() += 0.01;
  problem.keyframes.insert(problem.keyframes.begin() + 21, copy);
  const CubicSpline cubic({});
  const BSplineThrough b_spline({});
  const Dm dm({});
  for (const Smoother* smoother : {static_cast<const Smoother*>(&cubic),
                                   static_cast<const Smoother*>(&b_spline),
                                   static_cast<const Smoother*>(&dm)}) {
    Report report;
    const auto curve = smoother->smooth(problem, report);
    EXPECT_EQ(count(report, "chords"), 1.0);
    ASSERT_GE(report.notes.size(), 1u);
    EXPECT_NE(report.notes.back().find("0.01 times the median"), std::string::npos);
    for (std::size_t i = 15; i < 25; ++i) {
      EXPECT_LT(chord_deviation(*curve, problem.keyframes, i).first, 0.5) << i;
    }
  }
}

TEST(GaussianProcess, AGapOf1000SecondsIsAChord) {
  const Problem problem = with_gap(1000.0);
  Report report;
  const auto curve = GaussianProcess({}).smooth(problem, report);
  EXPECT_EQ(count(report, "chords"), 1.0);
  ASSERT_EQ(report.notes.size(), 1u);
  const auto [metres, radians] = chord_deviation(*curve, problem.keyframes, 39);
  EXPECT_NEAR(metres, 0.0, 1e-9);
  EXPECT_NEAR(radians, 0.0, 1e-9);
  EXPECT_GT(chord_deviation(*curve, problem.keyframes, 20).first, 1e-4);  // smooth elsewhere
  expect_near_keyframes(*curve, problem.keyframes, 0.02);
}

TEST(GaussianProcess, IntervalsBelowTheLimitAreSmoothed) {
  const double median = median_interval(hand_held_truth(40));
  for (const double gap : {10.0 * median, 49.0 * median, 0.055 * median}) {
    Report report;
    const auto curve = GaussianProcess({}).smooth(with_gap(gap), report);
    EXPECT_TRUE(report.notes.empty()) << gap;
    EXPECT_TRUE(is_finite(curve->at(curve->end())));
  }
}

TEST(GaussianProcess, AcceptsAPairOneMicrosecondApart) {
  Problem problem{.keyframes = hand_held_truth(60)};
  problem.keyframes.insert(problem.keyframes.begin() + 31, problem.keyframes[30]);
  problem.keyframes[31].stamp += 1e-6;
  Report report;
  const auto curve = GaussianProcess({}).smooth(problem, report);
  EXPECT_EQ(count(report, "chords"), 1.0);
  expect_near_keyframes(*curve, problem.keyframes, 0.02);
}

/// Keyframes 30 and later are rotated by another 150 degrees.
Problem with_large_step() {
  Problem problem{.keyframes = hand_held_truth(60)};
  const Rotation step = exp_so3(Vector3(0.0, 0.0, 150.0 / 180.0 * std::numbers::pi));
  for (std::size_t i = 30; i < 60; ++i) {
    Rotation& rotation = problem.keyframes[i].world_from_body.rotation;
    rotation = rotation * step;
  }
  return problem;
}

void expect_one_great_arc(const Smoother& smoother) {
  const Problem problem = with_large_step();
  const Problem plain{.keyframes = hand_held_truth(60)};
  Report report, other;
  const auto curve = smoother.smooth(problem, report);
  const auto smooth = smoother.smooth(plain, other);
  EXPECT_EQ(count(report, "great_arcs"), 1.0);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NEAR(chord_deviation(*curve, problem.keyframes, 29).second, 0.0, 1e-9);
  int curved = 0, curved_before = 0;
  for (std::size_t i = 0; i + 1 < 60; ++i) {
    curved += chord_deviation(*curve, problem.keyframes, i).second > 1e-6;
    curved_before += chord_deviation(*smooth, plain.keyframes, i).second > 1e-6;
  }
  EXPECT_GE(curved, curved_before - 1);
  expect_near_keyframes(*curve, problem.keyframes, 1e-9);
}

TEST(CubicSpline, AStepOf150DegreesIsOneGreatArc) { expect_one_great_arc(CubicSpline({})); }

TEST(BSpline, AStepOf150DegreesIsOneGreatArc) { expect_one_great_arc(BSplineThrough({})); }

TEST(Dm, AGapWithoutFramesIsAChord) {
  const Problem problem = with_gap(30.0);
  for (const int planar : {4, 5}) {
    Report report;
    const auto curve = Dm({.planar = planar}).smooth(problem, report);
    EXPECT_EQ(count(report, "chords"), 1.0);
    EXPECT_NEAR(chord_deviation(*curve, problem.keyframes, 39).first, 0.0, 1e-9);
    EXPECT_GT(chord_deviation(*curve, problem.keyframes, 20).first, 1e-4);
    Report never;
    const auto literal = Dm({.planar = planar, .chord_above = std::nullopt}).smooth(problem, never);
    EXPECT_GT(chord_deviation(*literal, problem.keyframes, 39).first, 0.5);
  }
}

TEST(Dm, AGapWithFramesIsFilled) {
  Problem problem = with_gap(30.0);
  const auto& [begin, a] = problem.keyframes[39];
  const auto& [end, b] = problem.keyframes[40];
  for (int k = 1; k < 300; ++k) {
    problem.frames.push_back({std::lerp(begin, end, k / 300.0), interpolate(a, b, k / 300.0)});
  }
  Report report;
  const auto curve = Dm({}).smooth(problem, report);
  for (const Count& each : report.counts) EXPECT_NE(each.name, "chords");
  EXPECT_GT(count(report, "quasi_keyframes"), 20.0);
}

}  // namespace
}  // namespace loopbench::test::gaps_test
