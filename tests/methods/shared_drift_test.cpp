/// Drift that is learnt from other chains of an odometer.
#include "methods/correctors/motion_drift/shared_drift.hpp"

#include <gtest/gtest.h>

#include "datasets/simulated/simulated.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/motion_drift/motion_drift.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/counts.hpp"

namespace loopbench::shared_drift_test {

using namespace methods;

namespace {

/// A drive of 1 km with that constant yaw rate [rad/m] in its odometry.
Problem drive(std::int64_t seed, double yaw_per_metre, std::int64_t closures = 4) {
  SimulatedOptions options;
  options.path = SimulatedPath::driving;
  options.seed = seed;
  options.noise.gain = 0.25;
  options.closures.max = closures;
  options.drift.yaw_per_metre = yaw_per_metre;
  return load_simulated(options).problem;
}

std::shared_ptr<const std::vector<Problem>> drives(std::size_t count,
                                                   double yaw_per_metre,
                                                   std::int64_t closures = 4) {
  auto out = std::make_shared<std::vector<Problem>>();
  for (std::size_t i = 0; i < count; ++i) {
    out->push_back(drive(static_cast<std::int64_t>(10 + i), yaw_per_metre, closures));
  }
  return out;
}

DriftRates learnt(const Problem& problem) {
  Report report;
  return repeated_drift(problem, report);
}

TEST(SharedDrift, FindsTheRateThatAllDrivesHave) {
  const SharedDrift found = shared_drift(*drives(5, 2e-4));
  EXPECT_NEAR(std::abs(found.mean.z()), 2e-4, 3.0 * std::sqrt(found.variance_of_mean.z()));
  EXPECT_LT(std::sqrt(found.variance_of_mean.z()), 3e-5);
  EXPECT_EQ(found.mean.w(), 0.0);  // rotation out of a plane
}

TEST(SharedDrift, FindsNothingWhereThereIsNoDrift) {
  EXPECT_TRUE(shared_drift(*drives(5, 0.0)).mean.isZero(0.0));
}

TEST(SharedDrift, RemovesRatesFromOdometryAndKeyframes) {
  // 2 m along x, then 3 m: 0.02 and 0.03 rad about z are added.
  Problem problem;
  problem.planar = true;
  problem.keyframes.resize(3);
  for (std::size_t i = 0; i < 2; ++i) {
    Edge edge{i, i + 1, {}};
    edge.from_from_to.translation.x() = i == 0 ? 2.0 : 3.0;
    problem.odometry.push_back(edge);
    problem.keyframes[i + 1].world_from_body =
        problem.keyframes[i].world_from_body * edge.from_from_to;
  }
  const Problem out = without_drift(problem, {0.0, 0.0, 0.01, 0.5});
  EXPECT_NEAR(log_so3(out.odometry[0].from_from_to.rotation).z(), 0.02, 1e-15);
  const Pose last = out.keyframes[2].world_from_body;
  EXPECT_NEAR(log_so3(last.rotation).z(), 0.05, 1e-15);
  EXPECT_NEAR(last.translation.x(), 2.0 + 3.0 * std::cos(0.02), 1e-15);
  EXPECT_NEAR(last.translation.y(), 3.0 * std::sin(0.02), 1e-15);
}

TEST(SharedDrift, RemovesAShareOfTheRotationInThePlane) {
  Problem problem;
  problem.planar = true;
  problem.keyframes.resize(2);
  Edge edge{0, 1, {}};
  edge.from_from_to.rotation = exp_so3(Vector3(0.0, 0.0, 0.4));
  problem.odometry = {edge};
  const auto angle = [&] {
    return log_so3(without_drift(problem, {0.0, 0.0, 0.0, 0.1}).odometry[0].from_from_to.rotation)
        .z();
  };
  EXPECT_NEAR(angle(), 0.44, 1e-15);
  problem.planar = false;
  EXPECT_NEAR(angle(), 0.4, 1e-15);
}

TEST(RepeatedDrift, NeedsThreeDrivesAndSixteenClosures) {
  Problem problem = drive(1, 2e-4);
  EXPECT_TRUE(learnt(problem).isZero(0.0));
  problem.related = drives(5, 2e-4);
  EXPECT_FALSE(learnt(problem).isZero(0.0));
  problem.related = drives(2, 2e-4, 10);
  EXPECT_TRUE(learnt(problem).isZero(0.0));
  problem.related = drives(3, 2e-4, 5);
  EXPECT_TRUE(learnt(problem).isZero(0.0));
}

TEST(RepeatedDrift, IsKeptWhereItMakesTheOwnLoopsLessLikely) {
  Problem problem = drive(1, -2e-4, 8);
  problem.related = drives(5, 2e-4);
  EXPECT_TRUE(learnt(problem).isZero(0.0));
}

TEST(RepeatedDrift, IsNotRemovedWhereDrivesDiffer) {
  Problem problem = drive(1, 2e-4);
  auto related = std::make_shared<std::vector<Problem>>();
  std::int64_t seed = 10;
  for (const double rate : {2e-4, -1e-4, 4e-4, -3e-4, -2e-4}) {
    related->push_back(drive(seed++, rate));
  }
  problem.related = related;
  EXPECT_TRUE(learnt(problem).isZero(0.0));
}

TEST(RepeatedDrift, StaysInThePlane) {
  Problem problem = drive(1, 2e-4);
  problem.related = drives(5, 2e-4);
  DriftRates expected = learnt(problem);
  problem.planar = true;
  expected.head<2>().setZero();
  EXPECT_EQ(learnt(problem).head<2>(), expected.head<2>());
}

TEST(RepeatedDrift, NotesThatTooLittleIsKnown) {
  Problem problem = drive(1, 2e-4);
  problem.related = drives(2, 2e-4);
  Report report;
  repeated_drift(problem, report);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_EQ(
      report.notes[0],
      "nothing is learnt from 2 related chains with 8 closures: 3 chains with 16 closures are "
      "needed");
}

TEST(MotionDrift, RemovesWhatRelatedDrivesRepeat) {
  Problem problem = drive(1, 2e-4, 2);
  const Trajectory alone = test::corrected<MotionDrift>(problem);
  problem.related = drives(5, 2e-4);
  Report report;
  const Trajectory out = MotionDrift({}).correct(problem, report);
  const DriftRates removed = learnt(problem);
  EXPECT_EQ(test::count(report, "shared.per_metre.z"), removed.z());
  EXPECT_EQ(test::count(report, "abstained"), 1.0);
  const Problem without = without_drift(problem, removed);
  test::expect_close(out, test::corrected<Dual>(without, {.rescale = true}), 0.0);
  test::expect_close(alone, test::corrected<MotionDrift>(problem, {.related = false}), 0.0);
}

}  // namespace
}  // namespace loopbench::shared_drift_test
