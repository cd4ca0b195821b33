// Lever arm and clock from positions: derivatives, coverage of intervals, what a path determines.
#include "metrics/checks/point_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "metrics/checks/lever_arm.hpp"
#include "support.hpp"

namespace loopbench::point_offset_test {

using namespace metrics;

namespace {

using namespace test;

const Vector3 kLeverArm(0.1, -0.25, 0.3);
constexpr double kOffset = 0.12;
constexpr double kLongest = 1.0;

/// A figure of eight with three axes of rotation, or only yaw.
Pose pose_at(double t, bool planar) {
  const double tilt = planar ? 0.0 : 0.3;
  return {exp_so3({0, 0, std::sin(0.7 * t)}) * exp_so3({tilt * std::sin(1.1 * t), 0, 0}) *
              exp_so3({0, tilt * std::cos(0.9 * t), 0}),
          {4.0 * std::sin(0.35 * t), 3.0 * std::sin(0.7 * t), planar ? 0.0 : std::cos(0.5 * t)}};
}

Trajectory path(double end, double step, bool planar = false) {
  Trajectory out;
  for (double t = 0.0; t <= end; t += step) out.push_back({t, pose_at(t, planar)});
  return out;
}

/// Positions of the point in another world, with noise of `sigma` [m] correlated from point to
/// point by `rho`.
Trajectory points(std::mt19937_64& random,
                  std::size_t count,
                  double end,
                  double sigma,
                  double rho,
                  bool planar = false) {
  std::normal_distribution<double> normal(0.0, sigma);
  const Pose there_from_here{exp_so3({0.4, -0.2, 2.0}), {10, -20, 5}};
  Trajectory out;
  Vector3 error(normal(random), normal(random), normal(random));
  for (std::size_t i = 0; i < count; ++i) {
    const double time = 1.0 + (end - 2.0) * static_cast<double>(i) / static_cast<double>(count);
    const Vector3 position = there_from_here * (pose_at(time, planar) * kLeverArm);
    out.push_back({time + kOffset, {no_rotation(), position + error}});
    const Vector3 fresh(normal(random), normal(random), normal(random));
    error = rho * error + std::sqrt(1.0 - rho * rho) * fresh;
  }
  return out;
}

TEST(PointOffset, DerivativesAgreeWithDifferences) {
  std::mt19937_64 random(3);
  PointOffsetProblem problem{points(random, 12, 20.0, 0.1, 0.0),
                             path(20.0, 0.1),
                             exp_so3({0.3, 0.1, 1.9}),
                             Eigen::Matrix<double, 11, 1>::Zero()};
  problem.x << 0.1, -0.2, 0.3, 9.0, -19.0, 4.0, 0.2, -0.1, 0.4, 0.0337, 1.1;
  Eigen::VectorXd residuals, plus, minus;
  Eigen::MatrixXd jacobian;
  problem.evaluate(kLongest, residuals, &jacobian);
  ASSERT_EQ(residuals.size(), 36);
  for (int k = 0; k < 11; ++k) {
    constexpr double kStep = 1e-6;
    PointOffsetProblem moved = problem;
    moved.x[k] += kStep;
    moved.evaluate(kLongest, plus, nullptr);
    moved.x[k] -= 2.0 * kStep;
    moved.evaluate(kLongest, minus, nullptr);
    const Eigen::VectorXd difference = (plus - minus) / (2.0 * kStep);
    EXPECT_LT((difference - jacobian.col(k)).norm(), 1e-6 * (1.0 + difference.norm())) << k;
  }
}

TEST(PointOffset, ExactPointsGiveTheExactValues) {
  std::mt19937_64 random(1);
  const PointOffset fit =
      fit_point_offset(points(random, 100, 60.0, 0.0, 0.0), path(60.0, 0.005), false, kLongest);
  EXPECT_LT((fit.lever_arm - kLeverArm).norm(), 1e-4);
  EXPECT_NEAR(fit.offset, kOffset, 1e-4);
  EXPECT_GT(fit.rmse_before, 0.1);
  EXPECT_LT(fit.rmse, 1e-4);
}

/// Share of 1000 cases whose 95 % interval contains the true value, for each parameter.
Eigen::Vector4d coverage_of(std::size_t count, double rho) {
  constexpr int kCases = 1000;
  std::mt19937_64 random(7);
  const Trajectory estimate = path(60.0, 0.02);
  Eigen::Vector4d inside = Eigen::Vector4d::Zero();
  for (int i = 0; i < kCases; ++i) {
    const PointOffset fit =
        fit_point_offset(points(random, count, 60.0, 0.03, rho), estimate, false, kLongest);
    Eigen::Vector4d error;
    error << fit.lever_arm - kLeverArm, fit.offset - kOffset;
    for (int k = 0; k < 4; ++k) inside[k] += std::abs(error[k]) <= fit.half_width(k) ? 1.0 : 0.0;
  }
  return inside / kCases;
}

// 1000 cases at 0.95 have a standard deviation of 0.007.
TEST(PointOffset, IntervalsContainTheTrueValuesAsOftenAsTheyState) {
  for (const auto& [count, rho, least] :
       {std::tuple{12u, 0.0, 0.93}, {300u, 0.0, 0.93}, {600u, 0.8, 0.90}}) {
    const Eigen::Vector4d share = coverage_of(count, rho);
    const std::string name = std::to_string(count) + (rho > 0.0 ? "_correlated" : "_points");
    for (int k = 0; k < 4; ++k) {
      RecordProperty("x" + name + "_" + std::to_string(k), std::to_string(share[k]));
    }
    EXPECT_GE(share.minCoeff(), least) << name << ": " << share.transpose();
    EXPECT_LE(share.maxCoeff(), 0.985) << name << ": " << share.transpose();
  }
}

TEST(PointOffset, APlanarPathDoesNotDetermineTheHeight) {
  std::mt19937_64 random(5);
  const Trajectory reference = points(random, 200, 60.0, 0.01, 0.0, true);
  const Trajectory estimate = path(60.0, 0.02, true);
  const PointOffset fit = fit_point_offset(reference, estimate, false, kLongest);
  EXPECT_TRUE(fit.is_observable[0] && fit.is_observable[1] && fit.is_observable[3]);
  EXPECT_FALSE(fit.is_observable[2]);
  EXPECT_TRUE(std::isinf(fit.half_width(2)));
  EXPECT_LT((fit.lever_arm - kLeverArm).head<2>().norm(), 0.01);
  Evaluation evaluation =
      evaluate(reference, estimate, {.association = Association::interpolate_estimate});
  evaluation.context = {.reference = &reference, .estimate = &estimate};
  const std::vector<Score> scores = lever_arm(evaluation, {});
  EXPECT_EQ(scores[0].why_undefined, "");
  EXPECT_NE(scores[2].why_undefined.find("not observable"), std::string::npos);
}

TEST(PointOffset, TooFewPointsAndMissingRotationsAreStated) {
  std::mt19937_64 random(5);
  EXPECT_THROW(fit_point_offset(points(random, 4, 20.0, 0.0, 0.0), path(20.0, 0.1), false, 1.0),
               Undefined);
}

}  // namespace
}  // namespace loopbench::point_offset_test
