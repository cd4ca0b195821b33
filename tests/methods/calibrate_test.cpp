// Deviations that the closures show in place of those stated, in dual and pose_graph.
#include <gtest/gtest.h>

#include "methods/correctors/dual.hpp"
#include "methods/correctors/pose_graph.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/simulated_drive.hpp"

namespace loopbench::test::calibrate_test {
namespace {

Sequence simulated(std::int64_t seed) {
  return simulated_drive({.closures = 10, .seed = seed, .planar = false});
}

/// Stated: translation 10 times too uncertain, rotation 10 times too certain.
Problem misstated(Problem problem) {
  Twist shrink;
  shrink << 0.1, 0.1, 0.1, 10.0, 10.0, 10.0;
  for (Edge& edge : problem.odometry) {
    edge.information = (shrink.asDiagonal() * edge.information * shrink.asDiagonal()).eval();
  }
  return problem;
}

TEST(Calibrate, EstimatesWrongDeviationsFromTheClosures) {
  // Each estimated deviation is correct up to a factor of 3, and much better on average.
  double log_t = 0.0, log_r = 0.0;
  constexpr int kSeeds = 6;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Report report;
    corrected<Dual>(misstated(simulated(seed).problem), {.calibrate = true}, &report);
    const double t = std::log(count(report, "factor_t") / 0.1);
    const double r = std::log(count(report, "factor_r") / 10.0);
    EXPECT_LT(std::abs(t), std::log(3.0)) << seed;
    EXPECT_LT(std::abs(r), std::log(3.0)) << seed;
    log_t += t / kSeeds, log_r += r / kSeeds;
  }
  EXPECT_NEAR(log_t, 0.0, std::log(1.5));
  EXPECT_NEAR(log_r, 0.0, std::log(1.5));
}

TEST(Calibrate, DualIsAsGoodAsWithTheTrueCovariances) {
  double right = 0.0, wrong = 0.0, calibrated = 0.0;
  for (int seed = 1; seed <= 6; ++seed) {
    const Sequence sequence = simulated(seed);
    const Problem stated = misstated(sequence.problem);
    const Trajectory best = corrected<Dual>(sequence.problem);
    const Trajectory truth = at_stamps_of(best, sequence.reference);
    right += rmse(best, truth);
    wrong += rmse(corrected<Dual>(stated), truth);
    calibrated += rmse(corrected<Dual>(stated, {.calibrate = true}), truth);
  }
  EXPECT_GT(wrong, 1.1 * right);
  EXPECT_LT(calibrated, 1.03 * right);
}

TEST(Calibrate, DualAndPoseGraphAgreeAndTakeTheOldName) {
  const Problem stated = misstated(simulated(2).problem);
  Report a, b, old;
  const Trajectory dual = corrected<Dual>(stated, {.calibrate = true}, &a);
  const Trajectory graph = corrected<PoseGraphOptimizer>(stated, {.calibrate = true}, &b);
  EXPECT_EQ(count(a, "factor_t"), count(b, "factor_t"));
  EXPECT_EQ(count(a, "factor_r"), count(b, "factor_r"));
  EXPECT_LT(rmse(dual, graph), 1e-3);
  expect_close(corrected<Dual>(stated, {.rescale = true}, &old), dual, 0.0);
  EXPECT_TRUE(a.notes.empty());
  ASSERT_EQ(old.notes.size(), 1u);
  EXPECT_EQ(old.notes[0], "rescale is the old name of calibrate");
}

TEST(Calibrate, KeepsStatedDeviationsWhereTheClosuresDoNotDecide) {
  Problem problem = simulated(1).problem;
  problem.closures.resize(1);
  problem.closures.front().from_from_to.translation += Vector3(300.0, 200.0, 100.0);
  Report report;
  const Trajectory with = corrected<Dual>(problem, {.calibrate = true}, &report);
  EXPECT_EQ(count(report, "factor_t"), 1.0);
  EXPECT_EQ(report.notes.size(), 1u);
  expect_close(with, corrected<Dual>(problem), 1e-9);
}

}  // namespace
}  // namespace loopbench::test::calibrate_test
