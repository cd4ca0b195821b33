#include "datasets/derive/reference_body.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "datasets/dataset.hpp"
#include "tests/datasets/random_poses.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/refusal_of.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::reference_body_test {
namespace {

using testing::HasSubstr;

// A marker 2 m ahead of the vehicle, which has moved 3 m and rotated left: the marker is at (3, 2).
TEST(ReferenceBody, IsTakenBackToTheEstimatesBody) {
  const Rotation left = exp_so3({0.0, 0.0, std::numbers::pi / 2.0});
  const Trajectory marker{{0.0, {Rotation::Identity(), {2.0, 0.0, 0.0}}},
                          {1.0, {left, {3.0, 2.0, 0.0}}}};
  ReferenceBody ahead;
  ahead.x = 2.0;
  const Trajectory vehicle = to_estimate_body(marker, ahead);
  EXPECT_POSE_NEAR(vehicle[0].world_from_body, {}, 1e-12, 1e-12);
  EXPECT_POSE_NEAR(vehicle[1].world_from_body, {left, {3.0, 0.0, 0.0}}, 1e-12, 1e-12);
  EXPECT_EQ(vehicle[1].stamp, 1.0);
}

TEST(ReferenceBody, UndoesEveryOffset) {
  const Pose body_from_reference = exp_se3(twist({0.3, -0.2, 0.1}, {0.5, -1.0, 2.0}));
  const Rotation& rotation = body_from_reference.rotation;
  const Vector3& at = body_from_reference.translation;
  const ReferenceBody body{
      at.x(), at.y(), at.z(), rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  const Trajectory truth = random_walk(50, 3, 1.0, 0.5);
  Trajectory reference = truth;
  for (auto& [stamp, pose] : reference) pose = normalized(pose * body_from_reference);
  reference = to_estimate_body(reference, body);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_POSE_NEAR(reference[i].world_from_body, truth[i].world_from_body, 1e-9, 1e-9) << i;
  }
}

TEST(ReferenceBody, SameBodyKeepsEveryBit) {
  const Trajectory truth = random_walk(20, 4, 1.0, 0.5);
  EXPECT_TRUE(same_bits(to_estimate_body(truth, {}), truth));
}

TEST(ReferenceBody, IsAnOptionOfTrajectoriesAndGraphs) {
  const TemporaryFolder folder;
  folder.file("estimate.txt", "0 0 0 0 0 0 0 1\n1 3 0 0 0 0 0.70710678118 0.70710678118\n");
  folder.file("marker.txt", "0 2 0 0 0 0 0 1\n1 3 2 0 0 0 0.70710678118 0.70710678118\n");
  folder.file("vo.g2o", "EDGE_SE2 0 1 3 0 1.5707963267948966 1 0 0 1 0 1\n");
  folder.file("marker.g2o", "EDGE_SE2 0 1 1 2 1.5707963267948966 1 0 0 1 0 1\n");
  const DataRoot root{{folder.path()}};
  const Sequence trajectory = load_dataset(
      "trajectory",
      {{"estimate", "estimate.txt"}, {"reference", "marker.txt"}, {"reference_body.x", 2.0}},
      root);
  const Sequence graph = load_dataset(
      "pose_graph", {{"path", "vo.g2o"}, {"truth", "marker.g2o"}, {"reference_body.x", 2.0}}, root);
  for (const Sequence& sequence : {trajectory, graph}) {
    ASSERT_EQ(sequence.reference.size(), 2u);
    const Pose step =
        sequence.reference[0].world_from_body.inverse() * sequence.reference[1].world_from_body;
    EXPECT_TRUE(step.translation.isApprox(Vector3(3.0, 0.0, 0.0), 1e-9)) << step.translation;
  }
  const auto refusal = refusal_of([&] {
    load_dataset(
        "trajectory",
        {{"estimate", "estimate.txt"}, {"reference", "marker.txt"}, {"reference_body.qx", 1.0}},
        root);
  });
  EXPECT_THAT(refusal, HasSubstr("expected a unit quaternion"));
}

}  // namespace
}  // namespace loopbench::reference_body_test
