#include "metrics/body_offset.hpp"

#include <numbers>

#include "support.hpp"

namespace loopbench {
namespace {

using test::find;
using test::noisy;

Trajectory followed_at(const Pose& body_from_reference, Trajectory poses) {
  for (auto& [stamp, pose] : poses) pose = normalized(pose * body_from_reference);
  return poses;
}

Trajectory hand_held() {
  std::mt19937_64 random(7);
  return test::random_walk(random, 300);
}

/// Ten metres a second; straight, a bend to the left, straight, a bend to the right.
Trajectory drive() {
  Trajectory out;
  Pose pose;
  for (int i = 0; i < 600; ++i) {
    out.push_back({0.5 * i, pose});
    const double bend = (i / 40 % 2) * (i / 80 % 2 == 0 ? 0.05 : -0.05);
    pose = normalized(pose * exp_se3(twist({5.0, 0.0, 0.0}, {0.0, 0.0, bend})));
  }
  return out;
}

TEST(BodyOffset, IsFoundWherePositionsBelongToAnotherPoint) {
  const Pose aside{Rotation::Identity(), {0.3, -0.2, 0.1}};
  const Trajectory estimate = hand_held();
  const auto found = body_offset(followed_at(aside, estimate), estimate, {});
  ASSERT_TRUE(found);
  EXPECT_TRUE(is_close(found->body_from_reference, aside, 1e-9, 1e-12));
  EXPECT_NEAR(found->explained, 1.0, 1e-12);
  EXPECT_LT(found->deviation.maxCoeff(), 1e-9);
  EXPECT_EQ(other_body(*found),
            "the reference seems to follow another body, at 0.3,-0.2,0.1 of the estimate's: that "
            "explains 100 % of how differently they move in turns");
}

TEST(BodyOffset, IsFoundWhereAxesDiffer) {
  // A camera (z forward) beside a vehicle (x forward).
  const Pose camera{Rotation(0.5, -0.5, 0.5, -0.5), {0.27, 0.0, -0.08}};
  const Trajectory estimate = hand_held();
  const auto found = body_offset(followed_at(camera, estimate), estimate, {});
  ASSERT_TRUE(found);
  EXPECT_TRUE(is_close(found->body_from_reference, camera, 1e-9, 1e-9));
  EXPECT_NE(other_body(*found).find("at 0.27,0.0,-0.08,-0.5,0.5,-0.5,0.5 of"), std::string::npos)
      << other_body(*found);
}

TEST(BodyOffset, SaysNothingOfTheSameBody) {
  std::mt19937_64 random(1);
  const Trajectory reference = hand_held();
  const auto exact = body_offset(reference, reference, {});
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->explained, 0.0);
  const auto found = body_offset(reference, noisy(random, reference, 0.05, 0.01), {});
  ASSERT_TRUE(found);
  EXPECT_LT(found->explained, 0.1);
  EXPECT_EQ(other_body(*found), "");
  EXPECT_LT(found->body_from_reference.translation.norm(), 5.0 * found->deviation.norm());
  EXPECT_EQ(angle_between(found->body_from_reference.rotation, Rotation::Identity()), 0.0);
}

// Along the only axis a vehicle turns about, no place can be told.
TEST(BodyOffset, LeavesUntoldDirectionsZero) {
  std::mt19937_64 random(2);
  const Pose ahead{Rotation::Identity(), {2.24, -0.12, 1.5}};
  const Trajectory truth = drive();
  const auto found = body_offset(followed_at(ahead, truth), noisy(random, truth, 0.02, 0.0), {});
  ASSERT_TRUE(found);
  const Vector3 at = found->body_from_reference.translation;
  EXPECT_NEAR(at.x(), 2.24, 5.0 * found->deviation.x());
  EXPECT_NEAR(at.y(), -0.12, 5.0 * found->deviation.y());
  EXPECT_LT(found->deviation.x(), 0.1);
  EXPECT_NEAR(at.z(), 0.0, 1e-6);
  EXPECT_GT(found->explained, 0.5);
}

// Steady drift and lost stretches are not taken for another body.
TEST(BodyOffset, IsNotDrift) {
  const Trajectory truth = drive();
  Trajectory drifting{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose step = truth[i - 1].world_from_body.inverse() * truth[i].world_from_body;
    const Pose error = exp_se3(twist({0.02, 0.0, 0.0}, {0.0, 0.0, 0.002}));
    const Pose& last = drifting.back().world_from_body;
    drifting.push_back({truth[i].stamp, normalized(last * step * error)});
  }
  const auto found = body_offset(truth, drifting, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(other_body(*found), "");
}

TEST(BodyOffset, NeedsTurnsAttitudesAndWholePositions) {
  Trajectory straight = drive();
  straight.resize(40);
  EXPECT_FALSE(body_offset(straight, straight, {}));
  Trajectory few = hand_held();
  few.resize(20);
  EXPECT_THROW(body_offset_scores(evaluate(few, few, {}), {}), Undefined);

  Trajectory positions = hand_held();
  for (auto& [stamp, pose] : positions) pose.rotation = Rotation::Identity();
  EXPECT_FALSE(body_offset(evaluate(positions, hand_held(), {}), {}));
  Protocol flat;
  flat.project = Plane::xy;
  EXPECT_FALSE(body_offset(evaluate(hand_held(), hand_held(), flat), {}));
}

// Wherever the worlds are, and in the unit of the aligned estimate.
TEST(BodyOffset, ScoresAreIndifferentToTheWorld) {
  const Pose aside{exp_so3({0.0, 0.5, 0.0}), {0.3, -0.2, 0.1}};
  std::mt19937_64 random(3);
  const Trajectory estimate = hand_held();
  const Pose moved = test::random_pose(random, 50.0, 2.0);
  const Trajectory reference = test::moved_by(moved, 1.0, followed_at(aside, estimate));
  const auto scores = body_offset_scores(evaluate(reference, estimate, {}), {});
  EXPECT_NEAR(find(scores, "position", "x").mean, 0.3, 1e-9);
  EXPECT_NEAR(find(scores, "position", "y").mean, -0.2, 1e-9);
  EXPECT_NEAR(find(scores, "position", "z").mean, 0.1, 1e-9);
  EXPECT_NEAR(find(scores, "turn", "").mean, 0.5 * 180.0 / std::numbers::pi, 1e-7);
  EXPECT_NEAR(find(scores, "explained", "").mean, 100.0, 1e-9);
}

}  // namespace
}  // namespace loopbench
