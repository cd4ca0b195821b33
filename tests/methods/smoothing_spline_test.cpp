// smoothing_spline and its parts.
#include "methods/smoothers/smoothing_spline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "datasets/simulated/simulated.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/penalised/unrolled.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/noisy_paths.hpp"

namespace loopbench::test::smoothing_spline_test {
namespace {

using testing::Contains;
using testing::StartsWith;

/// Dense hat matrix: A = (I + lambda Q R^-1 Q')^-1 (Green & Silverman 1994, 2.3.3).
Eigen::MatrixXd hat_matrix(const std::vector<double>& t, double lambda) {
  const auto n = static_cast<Eigen::Index>(t.size());
  Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(n, n - 2), R = Eigen::MatrixXd::Zero(n - 2, n - 2);
  for (Eigen::Index j = 0; j + 2 < n; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double before = t[i + 1] - t[i], after = t[i + 2] - t[i + 1];
    Q(j, j) = 1.0 / before;
    Q(j + 1, j) = -1.0 / before - 1.0 / after;
    Q(j + 2, j) = 1.0 / after;
    R(j, j) = (before + after) / 3.0;
    if (j + 3 < n) R(j, j + 1) = R(j + 1, j) = after / 6.0;
  }
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  return (I + lambda * Q * R.inverse() * Q.transpose()).inverse();
}

/// One point a row.
Eigen::MatrixXd rows(const std::vector<Vector3>& points) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = points[i];
  return out;
}

TEST(Reinsch, AgreesWithTheDenseComputationForTwelvePoints) {
  const std::vector<Vector3> y = wavy(kTwelve);
  const Eigen::MatrixXd Y = rows(y);
  const Reinsch reinsch(kTwelve);
  double offset = std::nan("");
  for (const double lambda : {1e-4, 1e-2, 1.0, 100.0}) {
    const Reinsch::Fit fit = reinsch.fit(y, lambda);
    const Eigen::MatrixXd A = hat_matrix(kTwelve, lambda);
    const Eigen::MatrixXd I_A = Eigen::MatrixXd::Identity(12, 12) - A;
    const Eigen::MatrixXd X = A * Y;
    EXPECT_NEAR((X - rows(fit.values)).rowwise().norm().maxCoeff(), 0.0, 1e-9);
    EXPECT_NEAR(fit.residual_dof, I_A.trace(), 1e-8);
    const double residual = (I_A * Y).squaredNorm();
    EXPECT_NEAR(fit.residual.sum(), residual, 1e-9 * residual + 1e-12);
    const double energy = (Y.transpose() * I_A * Y).trace();
    EXPECT_NEAR(fit.energy.sum(), energy, 1e-8);
    const double gcv = 12.0 * residual / std::pow(I_A.trace(), 2);
    EXPECT_NEAR(score(Criterion::gcv, fit, 12), gcv, 1e-7 * gcv);
    // det+ is the product of the ten nonzero eigenvalues.
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(I_A).eigenvalues();
    const double reml = 10.0 * std::log(energy) - values.tail(10).array().log().sum();
    const double difference = score(Criterion::reml, fit, 12) - reml;
    if (std::isnan(offset)) offset = difference;  // constant that depends on the stamps only
    EXPECT_NEAR(difference, offset, 1e-6);
  }
}

TEST(Reinsch, GoesFromInterpolationToTheStraightLine) {
  const std::vector<Vector3> y = wavy(kTwelve);
  const Reinsch reinsch(kTwelve);
  const Reinsch::Fit rough = reinsch.fit(y, 1e-12);
  EXPECT_NEAR((rows(rough.values) - rows(y)).rowwise().norm().maxCoeff(), 0.0, 1e-8);
  EXPECT_NEAR(12.0 - rough.residual_dof, 12.0, 1e-6);

  const Reinsch::Fit stiff = reinsch.fit(y, 1e10);
  Eigen::MatrixXd T(12, 2);
  for (int i = 0; i < 12; ++i) T.row(i) << 1.0, kTwelve[static_cast<std::size_t>(i)];
  const Eigen::MatrixXd line = T * (T.transpose() * T).inverse() * T.transpose() * rows(y);
  EXPECT_NEAR((line - rows(stiff.values)).rowwise().norm().maxCoeff(), 0.0, 1e-6);
  EXPECT_NEAR(12.0 - stiff.residual_dof, 2.0, 1e-6);
}

TEST(UnrolledRotations, ConstantAngularVelocityIsAStraightLine) {
  std::vector<Rotation> rotations;
  const Vector3 rate(0.3, -0.5, 0.8);
  for (int i = 0; i < 20; ++i) rotations.push_back(exp_so3({0.4, 1.0, -2.0}) * exp_so3(i * rate));
  const UnrolledRotations path(rotations);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR((path.unroll(i, rotations[i]) - static_cast<double>(i) * rate).norm(), 0.0, 1e-12);
  }
  EXPECT_NEAR(angle_between(path.roll(3, 0.25, 3.25 * rate), rotations[3] * exp_so3(0.25 * rate)),
              0.0,
              1e-12);
}

TEST(UnrolledRotations, RollingIsTheInverse) {
  const Trajectory path = hand_held_truth(30);
  std::vector<Rotation> base, near;
  for (const StampedPose& pose : path) {
    base.push_back(pose.world_from_body.rotation);
    near.push_back(base.back() * exp_so3({0.2, -0.1, 0.3}));
  }
  const UnrolledRotations flat(base);
  for (std::size_t i = 0; i < base.size(); ++i) {
    EXPECT_NEAR(angle_between(flat.roll(i, 0.0, flat.unroll(i, near[i])), near[i]), 0.0, 1e-12);
    if (i == 0) continue;  // also reached from the previous interval
    EXPECT_NEAR(angle_between(flat.roll(i - 1, 1.0, flat.unroll(i, near[i])), near[i]), 0.0, 1e-12);
  }
}

TEST(SmoothingSpline, ReproducesUniformMotionForAnyPenalty) {
  const auto truth = [](double time) {
    return Pose{exp_so3({0.3, 0.1, -1.0}) * exp_so3(time * Vector3(0.9, -1.5, 1.2)),
                Vector3(5.0, -2.0, 1.0) + time * Vector3(0.4, 0.3, -0.1)};
  };
  const Trajectory keyframes = sampled_at(kTwelve, truth);
  for (const Params& params : {Params{}, Params{{"lambda_t", 1e3}, {"lambda_r", 1e3}}}) {
    const auto curve = smooth<SmoothingSpline>(keyframes, params);
    expect_follows(*curve, keyframes, truth, 1e-9);
  }
}

TEST(SmoothingSpline, WithASmallPenaltyIsTheNaturalCubicSpline) {
  const Trajectory keyframes = hand_held_truth(30);
  const auto curve = smooth<SmoothingSpline>(keyframes, {{"lambda_t", 1e-12}, {"lambda_r", 1e-12}});
  const auto cubic = smooth<CubicSpline>(keyframes);
  for (double time = keyframes.front().stamp; time < keyframes.back().stamp; time += 0.05) {
    EXPECT_NEAR((curve->at(time).translation - cubic->at(time).translation).norm(), 0.0, 1e-8);
    // Two different curves on SO(3) through the same rotations.
    EXPECT_LT(angle_between(curve->at(time).rotation, cubic->at(time).rotation), 5e-3);
  }
  expect_close(curve->sample(stamps(keyframes)), keyframes, 1e-8);
}

TEST(SmoothingSpline, WithALargePenaltyAngularVelocityIsConstant) {
  const Trajectory keyframes = with_white_noise(hand_held_truth(20), 0.05, 3);
  Report report;
  const auto curve =
      smooth<SmoothingSpline>(keyframes, {{"lambda_t", 1e9}, {"lambda_r", 1e9}}, &report);
  EXPECT_NEAR(count(report, "dof_r"), 2.0, 1e-3);
  const double t = keyframes.front().stamp + 1.0;
  const auto rotation_step = [&](double from) {
    return log_so3(curve->at(from).rotation.conjugate() * curve->at(from + 0.5).rotation);
  };
  EXPECT_LT((rotation_step(t) - rotation_step(t + 2.0)).norm(), 1e-4);
  EXPECT_GT(rotation_step(t).norm(), 0.01);
}

TEST(SmoothingSpline, RemovesAFifthOrMoreOfWhiteNoise) {
  for (const char* criterion : {"gcv", "reml"}) {
    double before = 0.0, after = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Trajectory truth = hand_held_truth(120);
      const Trajectory keyframes = with_white_noise(truth, 0.02, seed);
      before += rms_error(*smooth<CubicSpline>(keyframes), truth);
      after += rms_error(
          *smooth<SmoothingSpline>(keyframes, {{"criterion", std::string(criterion)}}), truth);
    }
    EXPECT_LT(after, 0.8 * before) << criterion;
  }
}

/// At 40 keyframes the hand turns too fast between them, at 20 the path does too; the criterion
/// finds noise of 16 degrees and 0.3 m.
TEST(SmoothingSpline, InterpolatesWhereKeyframesDoNotResolveTheMotion) {
  for (const int keyframes : {20, 40}) {
    SimulatedOptions options;
    options.path = SimulatedPath::room;
    options.keyframes = keyframes;
    const Problem problem = load_simulated(options).problem;
    Report report;
    const auto curve = SmoothingSpline({}).smooth(problem, report);
    EXPECT_THAT(report.notes, Contains(StartsWith("rotations interpolated: smoothed, they would")));
    expect_close(curve->sample(stamps(problem.keyframes)), problem.keyframes, 1e-3);
  }
}

TEST(SmoothingSpline, HasNoKink) {
  const Trajectory keyframes = with_white_noise(hand_held_truth(20), 0.02, 5);
  Report report;
  const auto curve = smooth<SmoothingSpline>(keyframes, {}, &report);
  EXPECT_TRUE(report.notes.empty());
  expect_no_kink(*curve, keyframes);
}

}  // namespace
}  // namespace loopbench::test::smoothing_spline_test
