#include "metrics/errors/nees.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/covariance.hpp"
#include "metrics/numerics/autocorrelation.hpp"
#include "support.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::test::nees_test {
namespace {

using Covariances = std::vector<Matrix6>;

/// Scores of an estimate with covariances; `of_reference` is empty if it states none.
std::vector<Score> scores(const Trajectory& reference,
                          const Trajectory& estimate,
                          const Covariances& of_estimate,
                          Align align = Align::none,
                          const NeesOptions& options = {},
                          const Covariances& of_reference = {}) {
  Evaluation evaluation = evaluate(reference, estimate, {.align = align});
  evaluation.context = {.reference = &reference, .estimate = &estimate};
  evaluation.context.estimate_covariances = &of_estimate;
  if (!of_reference.empty()) evaluation.context.reference_covariances = &of_reference;
  return nees(evaluation, options);
}

double value(const std::vector<Score>& all, const std::string& relation, const std::string& axis) {
  return find(all, relation, axis).mean;
}

Matrix6 diagonal(double metres, double radians) {
  Matrix6 out = Matrix6::Zero();
  out.diagonal() << Vector3::Constant(metres * metres), Vector3::Constant(radians * radians);
  return out;
}

TEST(Nees, OfTwoPosesWorkedByHand) {
  // Position errors of 1 and 2 deviations along x, rotations of 3 and 0 deviations about z.
  const Rotation turned = exp_so3({0, 0, 0.03});
  const Trajectory reference{{0, {turned, {0.1, 0, 0}}}, {1, {Rotation::Identity(), {5.2, 0, 0}}}};
  const Trajectory estimate{{0, Pose{}}, {1, {Rotation::Identity(), {5, 0, 0}}}};
  const auto all = scores(reference, estimate, {2, diagonal(0.1, 0.01)});
  EXPECT_NEAR(find(all, "nees", "pose").max, 10.0, 1e-9);
  EXPECT_NEAR(find(all, "nees", "pose").min, 4.0, 1e-9);
  EXPECT_NEAR(value(all, "nees", "position"), 2.5, 1e-9);
  EXPECT_NEAR(value(all, "nees", "rotation"), 4.5, 1e-9);
  EXPECT_NEAR(value(all, "nees_ratio", "pose"), 14.0 / 12.0, 1e-9);
  // chi-squared of 6: 50 % up to 5.35, 90 % up to 10.64; of 1: 95 % up to 3.84.
  EXPECT_EQ(value(all, "coverage_50", "pose"), 50.0);
  EXPECT_EQ(value(all, "coverage_90", "pose"), 100.0);
  EXPECT_EQ(value(all, "coverage_95", "x"), 50.0);
  EXPECT_EQ(value(all, "coverage_95", "rz"), 50.0);
  EXPECT_EQ(value(all, "coverage_95", "y"), 100.0);
  // An equally uncertain reference halves all.
  const auto both = scores(
      reference, estimate, {2, diagonal(0.1, 0.01)}, Align::none, {}, {2, diagonal(0.1, 0.01)});
  EXPECT_NEAR(find(both, "nees", "pose").max, 5.0, 1e-9);
}

/// Each pose displaced by a draw from its covariance, in fixed axes; `memory` correlates
/// neighbours.
Trajectory drawn(std::mt19937_64& random,
                 Trajectory poses,
                 const Covariances& covariances,
                 double memory = 0.0) {
  std::normal_distribution<double> normal;
  Twist state = Twist::Zero();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Twist white;
    for (double& each : white) each = normal(random);
    state = i == 0 ? white : (memory * state + std::sqrt(1.0 - memory * memory) * white).eval();
    const Twist error = covariances[i].llt().matrixL() * state;
    Pose& pose = poses[i].world_from_body;
    const Vector3 phi = error.tail<3>();
    pose = normalized({exp_so3(phi) * pose.rotation, pose.translation + error.head<3>()});
  }
  return poses;
}

/// Positive definite, with correlations between all axes, different for each pose.
Covariances random_covariances(std::mt19937_64& random, std::size_t size) {
  std::normal_distribution<double> normal;
  Covariances out;
  for (std::size_t i = 0; i < size; ++i) {
    Matrix6 root = Matrix6::Identity();
    for (double& each : root.reshaped()) each += 0.4 * normal(random);
    const Twist size_of{0.1, 0.1, 0.1, 0.02, 0.02, 0.02};
    out.push_back(size_of.asDiagonal() * (root * root.transpose()) * size_of.asDiagonal());
  }
  return out;
}

TEST(Nees, CoversAsStatedIfAndOnlyIfTheModelIsRight) {
  constexpr int kSeeds = 60;
  std::map<double, double> covered;
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Trajectory truth = test::random_walk(random, 100);
    const Covariances stated = random_covariances(random, truth.size());
    const Trajectory estimate = drawn(random, truth, stated);
    const Pose elsewhere = test::random_pose(random, 50.0, 3.0);
    const Trajectory moved = test::moved_by(elsewhere, 1.0, estimate);
    for (const double factor : {0.25, 1.0, 4.0}) {
      Covariances scaled = stated;
      for (Matrix6& each : scaled) each *= factor;
      rotate(scaled, elsewhere);
      const auto all = scores(truth, moved, scaled, Align::se3);
      covered[factor] += value(all, "coverage_95", "pose") / kSeeds;
    }
  }
  EXPECT_NEAR(covered[1.0], 95.0, 1.5);
  EXPECT_LT(covered[0.25], 60.0);
  EXPECT_GT(covered[4.0], 99.0);
}

TEST(Nees, IntervalsKnowAboutAutocorrelation) {
  constexpr int kSeeds = 100;
  for (const double memory : {0.0, 0.9}) {
    int held = 0;
    double independent = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      std::mt19937_64 random(static_cast<std::uint64_t>(seed));
      const Trajectory truth = test::random_walk(random, 600);
      const Covariances stated(truth.size(), diagonal(0.1, 0.02));
      const auto all = scores(truth, drawn(random, truth, stated, memory), stated);
      held += value(all, "nees_ratio_low", "pose") <= 1.0 &&
              1.0 <= value(all, "nees_ratio_high", "pose");
      independent += value(all, "independent", "") / kSeeds;
    }
    EXPECT_GE(held, 88) << memory;
    // The NEES of an AR(1) process has the autocorrelation memory^2k: (1 - 0.81) / (1 + 0.81).
    EXPECT_NEAR(independent, memory == 0.0 ? 600.0 : 63.0, 20.0);
  }
}

TEST(Nees, DoesNotDependOnTheFrameOrTheScaleOfTheEstimate) {
  std::mt19937_64 random(3);
  const Trajectory truth = test::random_walk(random, 60);
  const Covariances stated = random_covariances(random, truth.size());
  const Trajectory estimate = drawn(random, truth, stated);
  const auto expected = scores(truth, estimate, stated, Align::sim3);
  const Pose elsewhere = test::random_pose(random, 20.0, 2.0);
  Covariances moved = stated;
  rotate(moved, elsewhere, 0.5);
  Trajectory half = test::moved_by(elsewhere, 0.5, estimate);
  for (StampedPose& pose : half) pose.world_from_body.translation += Vector3(1, 2, 3);
  const auto found = scores(truth, half, moved, Align::sim3);
  // The gauge overrules the protocol's alignment, also if that has changed the scale.
  const auto gauged = scores(truth, half, moved, Align::scale, {Gauge::sim3});
  for (const Score& score : expected) {
    const double tolerance = 1e-6 * (1.0 + std::abs(score.statistics.mean));
    EXPECT_NEAR(value(found, score.relation, score.axis), score.statistics.mean, tolerance);
    EXPECT_NEAR(value(gauged, score.relation, score.axis), score.statistics.mean, tolerance);
  }
}

TEST(Nees, OfADriftIsRightFromTheFirstPoseAndWrongAfterLeastSquaresOfPositions) {
  constexpr int kSeeds = 40;
  double from_origin = 0.0, after_weighted_fit = 0.0, after_fit = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::normal_distribution<double> normal;
    Trajectory truth = test::random_walk(random, 100), estimate = truth;
    Covariances stated{diagonal(1e-6, 1e-6)};
    Vector3 drift = Vector3::Zero();
    for (std::size_t i = 1; i < truth.size(); ++i) {
      for (double& each : drift) each += 0.01 * normal(random);
      estimate[i].world_from_body.translation += drift;
      stated.push_back(diagonal(0.01 * std::sqrt(static_cast<double>(i)), 1e-3));
    }
    const Pose elsewhere = test::random_pose(random, 50.0, 3.0);
    estimate = test::moved_by(elsewhere, 1.0, estimate);
    rotate(stated, elsewhere);
    const auto ratio = [&](Gauge gauge) {
      const auto all = scores(truth, estimate, stated, Align::se3, {gauge});
      return value(all, "nees", "position") / 3.0 / kSeeds;
    };
    from_origin += ratio(Gauge::origin);
    after_weighted_fit += ratio(Gauge::weighted);
    after_fit += ratio(Gauge::protocol);
  }
  EXPECT_NEAR(from_origin, 1.0, 0.3);
  EXPECT_NEAR(after_weighted_fit, 1.0, 0.3);
  EXPECT_GT(after_fit, 100.0);  // the first pose, stated as exact, is moved
}

TEST(Nees, OfAnotherPointOfTheBodyIsTheSame) {
  std::mt19937_64 random(5);
  const Trajectory truth = test::random_walk(random, 30);
  Covariances stated = random_covariances(random, truth.size());
  for (Matrix6& each : stated) each *= 1e-8;  // first order
  const Trajectory estimate = drawn(random, truth, stated);
  const Pose lever{exp_so3({0.3, -0.5, 0.2}), {1.0, -2.0, 0.5}};
  const auto on_lever = [&](Trajectory poses) {
    for (StampedPose& pose : poses) pose.world_from_body = pose.world_from_body * lever;
    return poses;
  };
  Covariances displaced_by_lever = stated;
  displace(displaced_by_lever, estimate, on_lever(estimate));
  const auto before = scores(truth, estimate, stated);
  const auto after = scores(on_lever(truth), on_lever(estimate), displaced_by_lever);
  EXPECT_NEAR(value(after, "nees", "pose"), value(before, "nees", "pose"), 1e-3);
  EXPECT_NEAR(value(after, "nees", "rotation"), value(before, "nees", "rotation"), 1e-3);
  EXPECT_GT(std::abs(value(after, "nees", "position") - value(before, "nees", "position")), 0.01);
}

// Errors of 2 deviations along x and 3 about z, the others have none: three degrees of freedom.
TEST(Nees, InThePlaneHasThreeDegreesOfFreedom) {
  const Trajectory reference{{0, Pose{}}, {1, {exp_so3({0, 0, 0.03}), {5.2, 0, 0}}}};
  const Trajectory estimate{{0, Pose{}}, {1, {Rotation::Identity(), {5, 0, 0}}}};
  Matrix6 plane = diagonal(0.1, 0.01);
  for (const Eigen::Index axis : {2, 3, 4}) plane(axis, axis) = 0.0;
  const Covariances stated{Matrix6::Zero(), plane};  // the first pose is exact
  const auto all = scores(reference, estimate, stated, Align::none, {.gauge = Gauge::origin});
  EXPECT_NEAR(value(all, "nees", "pose"), 13.0, 1e-9);
  EXPECT_NEAR(value(all, "nees", "position"), 4.0, 1e-9);
  EXPECT_NEAR(value(all, "nees", "rotation"), 9.0, 1e-9);
  EXPECT_NEAR(value(all, "nees_ratio", "pose"), 13.0 / 3.0, 1e-9);
  // chi-squared of 2: 50 % up to 1.39, 90 % up to 4.61.
  EXPECT_EQ(value(all, "coverage_50", "position"), 0.0);
  EXPECT_EQ(value(all, "coverage_90", "position"), 100.0);
  EXPECT_EQ(value(all, "coverage_95", "pose"), 0.0);
  EXPECT_THAT(refusal_of([&] { scores(reference, estimate, stated, Align::none); }),
              testing::HasSubstr("relative to the first pose, which needs gauge origin"));
  std::mt19937_64 random(8);
  const Trajectory walk = test::random_walk(random, 9);
  EXPECT_THAT(refusal_of([&] {
                scores(walk, walk, {9, plane}, Align::se3);
              }),
              testing::HasSubstr("planar covariances have no weighted alignment"));
}

TEST(Nees, OfPositionsHasNoRotation) {
  std::mt19937_64 random(6);
  const Trajectory estimate = test::random_walk(random, 20);
  Trajectory positions = estimate;
  for (StampedPose& pose : positions) {
    pose.world_from_body.translation.x() += 0.1;
    pose.world_from_body.rotation = no_rotation();
  }
  const auto all = scores(positions, estimate, {20, diagonal(0.1, 0.01)});
  EXPECT_NEAR(value(all, "nees", "position"), 1.0, 1e-9);
  for (const Score& score : all) {
    if (score.relation != "nees" || score.axis == "position") continue;
    EXPECT_THAT(score.why_undefined, testing::HasSubstr("positions without rotation"));
  }
}

TEST(Nees, SaysWhyItIsUndefined) {
  const Trajectory poses{{0, Pose{}}, {1, {Rotation::Identity(), {1, 0, 0}}}};
  Evaluation evaluation = evaluate(poses, poses, {.align = Align::none});
  EXPECT_THROW(nees(evaluation), Undefined);
  Matrix6 flat = diagonal(0.1, 0.1);
  flat(2, 2) = 0.0;
  EXPECT_THAT(refusal_of([&] {
                scores(poses, poses, {2, flat});
              }),
              testing::HasSubstr("the covariance at stamp 0.000000000 is not positive definite"));
}

TEST(Covariance, IsLinearBetweenPoses) {
  const Trajectory poses{{0, Pose{}}, {2, Pose{}}};
  const Covariances covariances{diagonal(1, 1), diagonal(2, 2)};
  EXPECT_EQ(covariance_at(poses, covariances, -1.0)(0, 0), 1.0);
  EXPECT_EQ(covariance_at(poses, covariances, 0.5)(0, 0), 1.75);
  EXPECT_EQ(covariance_at(poses, covariances, 2.0)(0, 0), 4.0);
  EXPECT_EQ(covariance_at(poses, covariances, 9.0)(0, 0), 4.0);
}

}  // namespace
}  // namespace loopbench::test::nees_test
