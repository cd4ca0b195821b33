#include "methods/correctors/motion_drift/motion_drift.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/dual.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::motion_drift_test {

using namespace methods;

namespace {

Trajectory corrected(const MotionDrift::Options& options, const Problem& problem) {
  Report report;
  return MotionDrift(options).correct(problem, report);
}

double count(const Report& report, const std::string& name) {
  for (const Count& c : report.counts) {
    if (c.name == name) return c.value;
  }
  return std::nan("");
}

double rmse(const Trajectory& a, const Trajectory& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i].world_from_body.translation - truth[i].world_from_body.translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
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
    const Problem problem = with_variances(test::walk(seed, 14, 0.05), 0.04, 0.01);
    MotionDrift::Options options{.model = MotionDrift::Model::constant,
                                 .fit = false,
                                 .max_iterations = 100,
                                 .tolerance = 0.0};
    options.noise[0][0] = 0.04;
    options.noise[1][0] = 0.01;
    options.closures = {1.0, 1.0};
    Report report;
    const Trajectory corrected_poses = corrected(options, problem);
    const Trajectory dual =
        Dual({.max_iterations = 100, .tolerance = 0.0}).correct(problem, report);
    for (std::size_t i = 0; i < corrected_poses.size(); ++i) {
      EXPECT_TRUE(is_close(corrected_poses[i].world_from_body, dual[i].world_from_body, 1e-9, 1e-9))
          << i;
    }
  }
}

TEST(MotionDrift, CorrectsSteadyDriftThatNoiseCannotExplain) {
  // Two nested loops with equal errors of 0.002 to 0.004 m and 0.001 to 0.004 rad in every step.
  // Translation drift of about one percent of the distance must be given as an option
  // (motion_drift.hpp).
  const Trajectory truth = test::hand_held_truth();
  const Problem problem = test::hand_held();
  const double constant = rmse(corrected({.model = MotionDrift::Model::constant}, problem), truth);
  MotionDrift::Options with_drift;
  with_drift.drift[0][2] = 0.01;  // [m/m]
  const double drift = rmse(corrected(with_drift, problem), truth);
  EXPECT_LT(drift, 0.75 * constant);
}

TEST(MotionDrift, DistributesOneScalarLoopByDistance) {
  // Straight along x with steps of 1, 2 and 3 m and no rotation. The variance grows with distance,
  // and the closure is as precise as one metre, so each metre gets 0.1 m of the gap of 0.7 m.
  Problem problem;
  double x = 0.0;
  problem.keyframes.push_back({0.0, {Rotation::Identity(), Vector3::Zero()}});
  for (std::size_t i = 0; i < 3; ++i) {
    const double step = static_cast<double>(i + 1);
    x += step;
    problem.keyframes.push_back({x, {Rotation::Identity(), Vector3(x, 0, 0)}});
    problem.odometry.push_back(
        {i, i + 1, {Rotation::Identity(), Vector3(step, 0, 0)}, Matrix6::Identity()});
  }
  problem.closures.push_back(
      {0, 3, {Rotation::Identity(), Vector3(6.7, 0, 0)}, Matrix6::Identity()});
  MotionDrift::Options options{.model = MotionDrift::Model::distance, .fit = false};
  options.noise[0] = {0.0, 0.0, 1.0, 0.0, 0.0};
  options.noise[1] = {0.0, 1e-6, 0.0, 0.0, 0.0};
  options.closures = {1.0, 1.0};
  const Trajectory out = corrected(options, problem);
  EXPECT_NEAR(out[1].world_from_body.translation.x(), 1.1, 1e-9);
  EXPECT_NEAR(out[2].world_from_body.translation.x(), 3.3, 1e-9);
  EXPECT_NEAR(out[3].world_from_body.translation.x(), 6.6, 1e-9);
}

TEST(MotionDrift, IsIndependentOfScale) {
  // Unknown scale of a monocular camera: the same problem in decimetres.
  const Problem metres = test::hand_held();
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
  const Trajectory a = corrected({}, metres);
  const Trajectory b = corrected({}, decimetres);
  for (std::size_t i = 0; i < a.size(); ++i) {
    Pose scaled = b[i].world_from_body;
    scaled.translation /= 10.0;
    EXPECT_TRUE(is_close(a[i].world_from_body, scaled, 1e-6, 1e-6)) << i;
  }
}

TEST(MotionDrift, ReportsTheEstimatedModel) {
  Report report;
  MotionDrift({}).correct(test::hand_held(), report);
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
  MotionDrift({}).correct(test::planar(), report);
  EXPECT_TRUE(std::isnan(count(report, "drift.r.per_second.x")));
  EXPECT_GE(count(report, "drift.r.per_second.z"), 0.0);
}

TEST(MotionDrift, EqualsDualWhenCovariancesAreAsStated) {
  const Problem problem = test::hand_held();
  MotionDrift::Options options;
  options.prior.as_stated_probability = 1.0;
  options.prior.scaled_probability = 0.0;
  options.prior.drift_probability = 0.0;
  Report report;
  const Trajectory corrected_poses = MotionDrift(options).correct(problem, report);
  const Trajectory dual = Dual({.tolerance = 0.0}).correct(problem, report);
  EXPECT_EQ(count(report, "probability.as_stated"), 1.0);
  for (std::size_t i = 0; i < corrected_poses.size(); ++i) {
    EXPECT_TRUE(is_close(corrected_poses[i].world_from_body, dual[i].world_from_body, 1e-6, 1e-6))
        << i;
  }
}

TEST(MotionDrift, ResultHardlyDependsOnTheSeed) {
  const Problem problem = test::hand_held();
  const Trajectory truth = test::hand_held_truth();
  MotionDrift::Options other;
  other.sampling.seed = 2;
  const double a = rmse(corrected({}, problem), truth);
  EXPECT_NEAR(rmse(corrected(other, problem), truth), a, 0.1 * a);
}

TEST(MotionDrift, OneModelIsNearTheMeanOverModels) {
  const Problem problem = test::hand_held();
  const Trajectory truth = test::hand_held_truth();
  const double mean = rmse(corrected({}, problem), truth);
  EXPECT_NEAR(rmse(corrected({.average_closures = 0}, problem), truth), mean, 0.2 * mean);
}

TEST(MotionDrift, KeepsGivenValuesWithoutFit) {
  Report report;
  MotionDrift::Options options{.fit = false};
  options.drift[1][2] = 0.01;  // [rad/m]
  options.noise[1][3] = 0.0;   // term removed
  MotionDrift(options).correct(test::hand_held(), report);
  EXPECT_DOUBLE_EQ(count(report, "drift.r.per_metre.z"), 0.01);
  EXPECT_TRUE(std::isnan(count(report, "noise.r.per_radian")));
}

}  // namespace
}  // namespace loopbench::motion_drift_test
