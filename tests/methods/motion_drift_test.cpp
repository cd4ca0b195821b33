#include "methods/correctors/motion_drift/motion_drift.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/dual.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::motion_drift_test {

using namespace methods;

namespace {

using namespace test;

bool has_count(const Report& report, const std::string& name) {
  return std::ranges::count(report.counts, name, &Count::name) > 0;
}

/// Sets the same variances [m^2], [rad^2] on every edge.
Problem with_variances(Problem problem, double translation, double rotation) {
  Matrix6 information = Matrix6::Zero();
  information.diagonal() << Vector3::Constant(1.0 / translation), Vector3::Constant(1.0 / rotation);
  for (Edge& edge : problem.odometry) edge.information = information;
  return problem;
}

TEST(MotionDrift, EqualsDualForConstantVariancesWithoutDrift) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Problem problem = with_variances(walk(seed, 14, 0.05), 0.04, 0.01);
    MotionDrift::Options options{.fit = false, .max_iterations = 100, .tolerance = 0.0};
    options.noise = {{{0.04, 0.0, 0.0, 0.0, 0.0}, {0.01, 0.0, 0.0, 0.0, 0.0}}};
    options.drift[1] = {0.0, 0.0, 0.0, 0.0, 0.0};
    options.closures = {1.0, 1.0};
    expect_close(corrected<MotionDrift>(problem, options),
                 corrected<Dual>(problem, {.max_iterations = 100, .tolerance = 0.0}),
                 1e-9);
  }
}

TEST(MotionDrift, CorrectsSteadyDriftThatNoiseCannotExplain) {
  // Two nested loops with equal errors of 0.002 to 0.004 m and 0.001 to 0.004 rad in every step.
  // Translation drift of about one percent of the distance must be given as an option
  // (motion_drift.hpp).
  const Trajectory truth = hand_held_truth();
  const Problem problem = hand_held();
  const double dual = rmse(corrected<Dual>(problem), truth);
  MotionDrift::Options with_drift;
  with_drift.drift[0][2] = 0.01;  // [m/m]
  const double drift = rmse(corrected<MotionDrift>(problem, with_drift), truth);
  EXPECT_LT(drift, 0.75 * dual);
}

TEST(MotionDrift, DistributesOneScalarLoopByDistance) {
  // Straight along x with steps of 1, 2 and 3 m and no rotation. The variance grows with distance,
  // and the closure is as precise as one metre, so each metre gets 0.1 m of the gap of 0.7 m.
  Problem problem = along_x({0, 1, 3, 6}, {0, 1, 3, 6});
  problem.closures.push_back({0, 3, at_x(6.7)});
  MotionDrift::Options options{.fit = false};
  options.noise = {{{0.0, 0.0, 1.0, 0.0, 0.0}, {0.0, 1e-6, 0.0, 0.0, 0.0}}};
  options.drift[1] = {0.0, 0.0, 0.0, 0.0, 0.0};
  options.closures = {1.0, 1.0};
  const Trajectory out = corrected<MotionDrift>(problem, options);
  EXPECT_NEAR(out[1].world_from_body.translation.x(), 1.1, 1e-9);
  EXPECT_NEAR(out[2].world_from_body.translation.x(), 3.3, 1e-9);
  EXPECT_NEAR(out[3].world_from_body.translation.x(), 6.6, 1e-9);
}

TEST(MotionDrift, IsIndependentOfScale) {
  // Unknown scale of a monocular camera: the same problem in decimetres.
  const Problem metres = hand_held();
  Problem decimetres = metres;
  Twist scale = Twist::Ones();
  scale.head<3>().setConstant(0.1);
  for (StampedPose& k : decimetres.keyframes) k.world_from_body.translation *= 10.0;
  for (std::vector<Edge>* edges : {&decimetres.odometry, &decimetres.closures}) {
    for (Edge& e : *edges) {
      e.from_from_to.translation *= 10.0;
      e.information = scale.asDiagonal() * e.information * scale.asDiagonal();
    }
  }
  const Trajectory a = corrected<MotionDrift>(metres);
  Trajectory b = corrected<MotionDrift>(decimetres);
  for (StampedPose& k : b) k.world_from_body.translation /= 10.0;
  expect_close(a, b, 1e-6);
}

TEST(MotionDrift, ReportsTheEstimatedModel) {
  Report report;
  MotionDrift({}).correct(hand_held(), report);
  EXPECT_TRUE(std::isfinite(count(report, "log_evidence")));
  EXPECT_NEAR(count(report, "probability.as_stated") + count(report, "probability.scaled") +
                  count(report, "probability.free"),
              1.0,
              1e-9);
  EXPECT_GE(count(report, "probability.drift"), 0.0);
  EXPECT_GE(count(report, "noise.t.per_metre"), 0.0);  // 0 if the term is excluded
  EXPECT_GE(count(report, "drift.r.per_second.x"), 0.0);
  EXPECT_GT(count(report, "stated"), 0.0);
  EXPECT_GT(count(report, "closures.r"), 0.0);
}

TEST(MotionDrift, HasOneRotationDriftAxisInThePlane) {
  Report report;
  MotionDrift({.abstain_closures = 0}).correct(planar(), report);
  EXPECT_FALSE(has_count(report, "drift.r.per_second.x"));
  EXPECT_GE(count(report, "drift.r.per_second.z"), 0.0);
}

TEST(MotionDrift, EqualsDualWhenCovariancesAreAsStated) {
  const Problem problem = hand_held();
  MotionDrift::Options options;
  options.prior.as_stated_probability = 1.0;
  options.prior.scaled_probability = 0.0;
  options.prior.drift_probability = 0.0;
  Report report;
  expect_close(corrected<MotionDrift>(problem, options, &report),
               corrected<Dual>(problem, {.tolerance = 0.0}),
               1e-6);
  EXPECT_EQ(count(report, "probability.as_stated"), 1.0);
}

TEST(MotionDrift, EqualsDualWithFewClosuresThatShowNoDrift) {
  const Problem problem = walk(1, 14, 0.05);
  ASSERT_LT(problem.closures.size(), 8u);
  Report report;
  const Trajectory out = corrected<MotionDrift>(problem, {}, &report);
  EXPECT_EQ(count(report, "abstained"), 1.0);
  EXPECT_LT(count(report, "probability.drift"), 0.95);
  expect_close(out, corrected<Dual>(problem), 0.0);

  Report averaged;
  corrected<MotionDrift>(problem, {.abstain_closures = 0}, &averaged);
  EXPECT_FALSE(has_count(averaged, "abstained"));
  Report certain;
  corrected<MotionDrift>(problem, {.abstain_factor = 0.0}, &certain);
  EXPECT_FALSE(has_count(certain, "abstained"));
}

TEST(MotionDrift, ResultHardlyDependsOnTheSeed) {
  const Problem problem = hand_held();
  const Trajectory truth = hand_held_truth();
  MotionDrift::Options other;
  other.sampling.seed = 2;
  const double a = rmse(corrected<MotionDrift>(problem), truth);
  EXPECT_NEAR(rmse(corrected<MotionDrift>(problem, other), truth), a, 0.1 * a);
}

TEST(MotionDrift, OneModelIsNearTheMeanOverModels) {
  const Problem problem = hand_held();
  const Trajectory truth = hand_held_truth();
  const double mean = rmse(corrected<MotionDrift>(problem), truth);
  EXPECT_NEAR(
      rmse(corrected<MotionDrift>(problem, {.average_closures = 0}), truth), mean, 0.2 * mean);
}

TEST(MotionDrift, KeepsGivenValuesWithoutFit) {
  Report report;
  MotionDrift::Options options{.fit = false};
  options.drift[1][2] = 0.01;  // [rad/m]
  options.noise[1][3] = 0.0;   // term removed
  MotionDrift(options).correct(hand_held(), report);
  EXPECT_DOUBLE_EQ(count(report, "drift.r.per_metre.z"), 0.01);
  EXPECT_FALSE(has_count(report, "noise.r.per_radian"));
}

}  // namespace
}  // namespace loopbench::motion_drift_test
