#include "metrics/checks/extrinsic_offset.hpp"

#include <numbers>

#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::extrinsic_offset_test {
namespace {

Trajectory followed_at(const Pose& body_from_reference, Trajectory poses) {
  for (auto& [stamp, pose] : poses) pose = normalized(pose * body_from_reference);
  return poses;
}

Trajectory hand_held() {
  std::mt19937_64 random(7);
  return test::random_walk(random, 300);
}

/// 6 to 14 m/s; straight, a left bend, straight, a right bend.
Trajectory drive() {
  Trajectory out;
  Pose pose;
  for (int i = 0; i < 600; ++i) {
    out.push_back({0.5 * i, pose});
    const double bend = (i / 40 % 2) * (i / 80 % 2 == 0 ? 0.05 : -0.05);
    pose = normalized(pose *
                      exp_se3(twist({5.0 + 2.0 * std::sin(0.1 * i), 0.0, 0.0}, {0.0, 0.0, bend})));
  }
  return out;
}

/// 8 m/s, always turning left.
Trajectory circle() {
  Trajectory out;
  Pose pose;
  for (int i = 0; i < 3000; ++i) {
    out.push_back({0.1 * i, pose});
    pose = normalized(pose * exp_se3(twist({0.8, 0.0, 0.0}, {0.0, 0.0, 0.02})));
  }
  return out;
}

/// 30 s around a point two metres ahead, always facing it.
Trajectory around_a_thing() {
  Trajectory out;
  for (int i = 0; i < 900; ++i) {
    const double t = i / 30.0;
    const Rotation rotation = exp_so3({0.0, 1.2 * std::sin(0.5 * t), 0.0}) *
                              exp_so3({0.4 * std::sin(0.83 * t + 1.0), 0.0, 0.0});
    out.push_back({t, {rotation, rotation * Vector3(0.0, 0.0, -2.0)}});
  }
  return out;
}

/// A constant error per step plus small random errors.
Trajectory drifting(const Trajectory& truth, const Twist& error, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Trajectory out{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose step = truth[i - 1].world_from_body.inverse() * truth[i].world_from_body;
    const Pose chance = test::random_pose(random, 0.01, 0.0005);
    const Pose& last = out.back().world_from_body;
    out.push_back({truth[i].stamp, normalized(last * step * exp_se3(error) * chance)});
  }
  return out;
}

std::string said(const Trajectory& reference, const Trajectory& estimate) {
  const auto found = extrinsic_offset(reference, estimate, {});
  return found ? other_body(*found, {}) : "nothing found";
}

TEST(ExtrinsicOffset, IsFoundWherePositionsBelongToAnotherPoint) {
  const Pose aside{Rotation::Identity(), {0.3, -0.2, 0.1}};
  const Trajectory estimate = hand_held();
  const auto found = extrinsic_offset(followed_at(aside, estimate), estimate, {});
  ASSERT_TRUE(found);
  EXPECT_POSE_NEAR(found->fit.body_from_reference, aside, 1e-9, 1e-12);
  EXPECT_NEAR(found->fit.lever_arm_explained, 1.0, 1e-12);
  EXPECT_EQ(found->fit.rotation_explained, 0.0);
  EXPECT_NEAR(found->fit.deviation.maxCoeff(), 0.0, 1e-9);
  EXPECT_EQ(
      other_body(*found, {}),
      "the reference seems to track another body, with the offset 0.3,-0.2,0.1 in the estimate's "
      "body frame (+- "
      "0.0,0.0,0.0 m): over rotations, the lever arm explains 100 % of the squared differences");
}

TEST(ExtrinsicOffset, IsFoundWhereAxesDiffer) {
  // A camera (z forward) beside a vehicle (x forward).
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), {0.27, 0.0, -0.08}};
  const Trajectory estimate = hand_held();
  const auto found = extrinsic_offset(followed_at(camera, estimate), estimate, {});
  ASSERT_TRUE(found);
  EXPECT_POSE_NEAR(found->fit.body_from_reference, camera, 1e-9, 1e-9);
  EXPECT_NE(other_body(*found, {}).find("the offset 0.27,0.0,-0.08,-0.5,0.5,-0.5,0.5 in"),
            std::string::npos)
      << other_body(*found, {});
}

TEST(ExtrinsicOffset, SaysNothingOfTheSameBody) {
  std::mt19937_64 random(1);
  const Trajectory reference = hand_held();
  EXPECT_EQ(said(reference, reference), "");
  const auto found = extrinsic_offset(reference, noisy(random, reference, 0.05, 0.01), {});
  ASSERT_TRUE(found);
  EXPECT_LT(found->fit.lever_arm_explained, 0.1);
  EXPECT_EQ(other_body(*found, {}), "");
  EXPECT_EQ(angle_between(found->fit.body_from_reference.rotation, Rotation::Identity()), 0.0);
}

// Rotation alone does not determine the lever arm, which stays zero.
TEST(ExtrinsicOffset, DifferentAxesAloneSayNothingOfThePlace) {
  std::mt19937_64 random(4);
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), {1.0, 0.0, 0.0}};
  const Trajectory truth = circle();
  const std::string text = said(followed_at(camera, truth), noisy(random, truth, 0.02, 0.001));
  EXPECT_NE(text.find("the offset 0.0,0.0,0.0,-0.4"), std::string::npos) << text;
  EXPECT_EQ(text.find("place"), std::string::npos) << text;
}

// The lever arm is unobservable along the only rotation axis of a vehicle.
TEST(ExtrinsicOffset, LeavesUntoldDirectionsZero) {
  std::mt19937_64 random(2);
  const Pose ahead{Rotation::Identity(), {2.24, -0.12, 1.5}};
  const Trajectory truth = drive();
  const auto found =
      extrinsic_offset(followed_at(ahead, truth), noisy(random, truth, 0.02, 0.0), {});
  ASSERT_TRUE(found);
  const Vector3 at = found->fit.body_from_reference.translation;
  EXPECT_NEAR(at.x(), 2.24, 5.0 * found->fit.deviation.x());
  EXPECT_NEAR(at.y(), -0.12, 5.0 * found->fit.deviation.y());
  EXPECT_LT(found->fit.deviation.x(), 0.1);
  EXPECT_NEAR(at.z(), 0.0, 1e-6);
  EXPECT_GT(found->fit.lever_arm_explained, 0.5);
}

// If all rotations have the same sign, a constant error per step resembles a lever arm.
TEST(ExtrinsicOffset, IsNotSteadyDrift) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Twist error = twist({0.01, 0.005, 0.0}, {0.0, 0.0, 0.001});
    EXPECT_EQ(said(circle(), drifting(circle(), error, seed)), "");
    EXPECT_EQ(said(drive(), drifting(drive(), 2.0 * error, seed)), "");
  }
}

/// Planar motion does not determine the height; pitch drift once put it 10^4 m below.
TEST(ExtrinsicOffset, HasNoHeightInAPlane) {
  const Pose pitch = exp_se3(twist(Vector3::Zero(), {0.0, 5e-4, 0.0}));
  Trajectory truth, estimate;
  Pose pose, pitched;
  for (int i = 0; i < 600; ++i) {
    truth.push_back({0.1 * i, pose});
    estimate.push_back({0.1 * i, pitched});
    const Pose step = exp_se3(twist({0.5, 0.0, 0.0}, {0.0, 0.0, 0.05 * (i / 40 % 3 - 0.7)}));
    pose = normalized(pose * step);
    pitched = normalized(pitched * step * pitch);
  }
  const auto offset = extrinsic_offset(truth, estimate, {});
  ASSERT_TRUE(offset);
  EXPECT_LT(offset->fit.body_from_reference.translation.norm(), 1.0);
  EXPECT_EQ(other_body(*offset, {}), "");
}

// Motion around a viewed object resembles a lever arm.
TEST(ExtrinsicOffset, IsNotTheUnitOfLength) {
  std::mt19937_64 random(5);
  for (const double unit : {0.5, 0.9, 1.1, 2.0}) {
    const Trajectory seen = noisy(random, around_a_thing(), 0.005, 0.003);
    EXPECT_EQ(said(around_a_thing(), test::moved_by({}, unit, seen)), "") << unit;
  }
  const Pose aside{Rotation::Identity(), {0.3, -0.2, 0.1}};
  const auto found =
      extrinsic_offset(followed_at(aside, hand_held()), test::moved_by({}, 0.5, hand_held()), {});
  ASSERT_TRUE(found);  // in the reference's scale nevertheless
  EXPECT_POSE_NEAR(found->fit.body_from_reference, aside, 1e-9, 1e-12);
}

TEST(ExtrinsicOffset, IsFoundDespiteAJump) {
  std::mt19937_64 random(6);
  const Pose aside{Rotation::Identity(), {0.3, 0.0, 0.0}};
  Trajectory estimate = noisy(random, hand_held(), 0.01, 0.002);
  for (std::size_t i = 150; i < estimate.size(); ++i) {
    estimate[i].world_from_body.translation.x() += 50.0;
  }
  const auto found = extrinsic_offset(followed_at(aside, hand_held()), estimate, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->fit.body_from_reference.translation.x(), 0.3, 0.02);
  EXPECT_GT(found->fit.lever_arm_explained, 0.5);
}

// The reported offset replaces the stated one.
TEST(ExtrinsicOffset, PlacesAreToldFromTheEstimatesBody) {
  const Pose body_from_reference{Rotation(0.5, -0.5, 0.5, -0.5), {0.27, 0.1, -0.08}};
  const Pose stated{exp_so3({0.0, 0.0, 1.0}), {1.0, 0.0, 0.0}};
  const Trajectory estimate = hand_held();
  const Trajectory moved = followed_at(body_from_reference * stated.inverse(), estimate);
  const auto found = extrinsic_offset(moved, estimate, {});
  ASSERT_TRUE(found);
  EXPECT_NE(other_body(*found, stated).find("the offset 0.27,0.1,-0.08,-0.5,0.5,-0.5,0.5 in"),
            std::string::npos)
      << other_body(*found, stated);
}

TEST(ExtrinsicOffset, NeedsTurnsInTimeAttitudesAndWholePositions) {
  Trajectory straight = drive();
  straight.resize(40);
  EXPECT_FALSE(extrinsic_offset(straight, straight, {}));
  Trajectory few = hand_held();
  few.resize(20);
  EXPECT_THROW(extrinsic_offset_scores(evaluate(few, few, {}), {}), Undefined);
  Trajectory slow = hand_held();
  for (auto& [stamp, pose] : slow) stamp *= 200.0;  // 20 s between poses
  EXPECT_FALSE(extrinsic_offset(slow, slow, {}));

  Trajectory positions = hand_held();
  for (auto& [stamp, pose] : positions) pose.rotation = Rotation::Identity();
  EXPECT_FALSE(extrinsic_offset(evaluate(positions, hand_held(), {}), {}));
  Protocol flat;
  flat.project = ProjectionPlane::xy;
  EXPECT_FALSE(extrinsic_offset(evaluate(hand_held(), hand_held(), flat), {}));
}

TEST(ExtrinsicOffset, ScoresAreIndifferentToTheWorld) {
  const Pose aside{exp_so3({0.0, 0.5, 0.0}), {0.3, -0.2, 0.1}};
  std::mt19937_64 random(3);
  const Trajectory estimate = hand_held();
  const Pose moved = test::random_pose(random, 50.0, 2.0);
  const Trajectory reference = test::moved_by(moved, 1.0, followed_at(aside, estimate));
  const auto scores = extrinsic_offset_scores(evaluate(reference, estimate, {}), {});
  EXPECT_NEAR(find(scores, "position", "x").mean, 0.3, 1e-9);
  EXPECT_NEAR(find(scores, "position", "y").mean, -0.2, 1e-9);
  EXPECT_NEAR(find(scores, "position", "z").mean, 0.1, 1e-9);
  EXPECT_NEAR(find(scores, "position_std", "x").mean, 0.0, 1e-9);
  EXPECT_NEAR(find(scores, "quaternion", "y").mean, std::sin(0.25), 1e-9);
  EXPECT_NEAR(find(scores, "quaternion", "w").mean, std::cos(0.25), 1e-9);
  EXPECT_NEAR(find(scores, "rotation", "").mean, 0.5 * 180.0 / std::numbers::pi, 1e-7);
  EXPECT_GT(find(scores, "rotation_explained", "").mean, 50.0);
  EXPECT_NEAR(find(scores, "lever_arm_explained", "").mean, 100.0, 1e-9);
  EXPECT_GT(find(scores, "relative_poses", "").mean, 100.0);
}

}  // namespace
}  // namespace loopbench::test::extrinsic_offset_test
