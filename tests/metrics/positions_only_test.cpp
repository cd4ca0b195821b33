// References without rotation, control points, and scores that survive failures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "metrics/checks/diagnostics.hpp"
#include "metrics/doctor/diagnose.hpp"
#include "metrics/errors/accuracy.hpp"
#include "metrics/errors/ape.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/protocols/protocols.hpp"
#include "support.hpp"

namespace loopbench::test::positions_only_test {
namespace {

using testing::HasSubstr;

Trajectory without_rotations(Trajectory poses) {
  for (StampedPose& pose : poses) pose.world_from_body.rotation = no_rotation();
  return poses;
}

TEST(PositionsOnly, RotationScoresSayWhyTheyAreAbsent) {
  std::mt19937_64 random(1);
  const Trajectory estimate = random_walk(random, 200);
  const Trajectory reference = without_rotations(noisy(random, estimate, 0.05, 0.0));
  Evaluation e = evaluate(reference, estimate, {});
  e.context = {.reference = &reference, .estimate = &estimate};
  const std::string why =
      "the reference has positions without rotation, so rotation is not evaluated";
  EXPECT_EQ(why_no_attitude(e), why);
  for (const MetricEntry& metric : metrics::metrics()) {
    try {
      for (const Score& score : metric.score(e, {})) {
        if (score.why_undefined.empty()) EXPECT_TRUE(std::isfinite(score.statistics.mean));
        if (score.unit == "deg") EXPECT_EQ(score.why_undefined, why) << metric.name;
      }
    } catch (const Undefined&) {
      continue;  // stated
    }
  }
  EXPECT_TRUE(std::isnan(pose_errors(e).front().radians.x()));
}

TEST(PositionsOnly, AlignmentsFromPositionsEqualThoseOfTheFullReference) {
  std::mt19937_64 random(2);
  const Trajectory estimate = random_walk(random, 200);
  const Trajectory full = noisy(random, estimate, 0.05, 0.02);
  for (const Align align : {Align::se3, Align::sim3, Align::scale, Align::posyaw, Align::none}) {
    const double expected = ate(evaluate(full, estimate, {.align = align}), {})[0].statistics.rmse;
    EXPECT_EQ(
        ate(evaluate(without_rotations(full), estimate, {.align = align}), {})[0].statistics.rmse,
        expected);
  }
  for (const Align align : {Align::origin, Align::posyaw_origin}) {
    EXPECT_THAT(why<std::runtime_error>([&] {
                  evaluate(without_rotations(full), without_rotations(estimate), {.align = align});
                }),
                HasSubstr("the reference has positions without rotation"));
  }
}

TEST(PositionsOnly, DoctorFindsNoFault) {
  std::mt19937_64 random(3);
  const Trajectory estimate = random_walk(random, 600);
  Trajectory reference;
  for (std::size_t i = 0; i < estimate.size(); i += 10) reference.push_back(estimate[i]);
  reference = without_rotations(reference);
  for (const InputFinding& finding :
       diagnosis(reference, estimate, "fix.txt", "a.txt", true).findings) {
    ADD_FAILURE() << text(finding);
  }
}

TEST(ControlPoints, TheEstimateIsInterpolatedAtThem) {
  // A straight line at 1 m/s with a corner; points between its poses, one in a gap.
  const Trajectory estimate{
      {0, {{}, {0, 0, 0}}}, {1, {{}, {1, 0, 0}}}, {2, {{}, {1, 1, 0}}}, {9, {{}, {1, 8, 0}}}};
  const Trajectory reference{{0.5, {no_rotation(), {0.5, 0, 0}}},
                             {1.25, {no_rotation(), {1, 0.25, 0.02}}},
                             {5.0, {no_rotation(), {1, 4, 0}}},
                             {20.0, {no_rotation(), {0, 0, 0}}}};
  const Protocol rules{
      .association = Association::interpolate_estimate, .max_gap = 1.0, .align = Align::none};
  const Evaluation e = evaluate(reference, estimate, rules);
  EXPECT_EQ(e.coverage.pairs, 2u);
  EXPECT_EQ(e.coverage.possible, 4u);
  EXPECT_NEAR(ate(e, {})[0].statistics.max, 0.02, 1e-12);
  // 20 points for 0 m, 6 for 2 cm, none for the two without a pair.
  const auto scores = control_points(e, {});
  EXPECT_NEAR(scores[0].statistics.mean, 100.0 * 26.0 / 80.0, 1e-9);
  EXPECT_EQ(find(scores, "within", "0.01").mean, 25.0);
  EXPECT_EQ(find(scores, "within", "0.03").mean, 50.0);
  EXPECT_EQ(named_protocol("hilti").rules.association, Association::interpolate_estimate);
}

TEST(ControlPoints, PointsOfTheChallengeOf2023) {
  // README of the Hilti SLAM Challenge 2023: < 0.5, 1, 3, 6, 10, 40 cm give 20, 10, 6, 5, 3, 1.
  const double errors[] = {0.0049, 0.005, 0.0299, 0.0599, 0.0999, 0.3999, 0.4};
  Evaluation e;
  e.coverage.possible = std::size(errors);
  for (std::size_t i = 0; i < std::size(errors); ++i) {
    e.reference.push_back({static_cast<double>(i), {no_rotation(), {0, 0, 0}}});
    e.estimate.push_back({static_cast<double>(i), {{}, {errors[i], 0, 0}}});
  }
  const double expected = 100.0 * (20 + 10 + 6 + 5 + 3 + 1 + 0) / (20 * 7);
  EXPECT_NEAR(control_points(e, {})[0].statistics.mean, expected, 1e-9);
  EXPECT_THROW(check_combination(ControlPointsOptions{.points = "20 10"}), OptionError);
  EXPECT_THROW(check_combination(ControlPointsOptions{.thresholds = "1 0.5 3 6 10 40"}),
               OptionError);
}

TEST(Accuracy, MissingTimeCountsAsFailed) {
  // 100 s at 1 m/s; the estimate exists from 10 to 50 s and from 70 to 100 s, errors 0.05 and 0.5
  // m.
  Trajectory reference, estimate;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.1 * i;
    reference.push_back({t, {{}, {t, 0, 0}}});
    const bool is_early = 10.0 <= t && t <= 50.0;
    if (!is_early && t < 70.0) continue;
    estimate.push_back({t, {{}, {t, is_early ? 0.05 : 0.5, 0}}});
  }
  Evaluation e = evaluate(reference, estimate, {.align = Align::none});
  e.context = {.reference = &reference, .estimate = &estimate};
  const auto scores = accuracy(e, {.thresholds = "0.1 1"});
  EXPECT_NEAR(find(scores, "within", "0.1").mean, 40.0, 0.2);
  EXPECT_NEAR(find(scores, "within", "1").mean, 70.0, 0.2);
  EXPECT_NEAR(find(scores, "area", "").mean, 40.0 * 0.95 + 30.0 * 0.5, 0.2);
  EXPECT_THROW(check_combination(AccuracyOptions{"0.1 x"}), OptionError);
}

}  // namespace
}  // namespace loopbench::test::positions_only_test
