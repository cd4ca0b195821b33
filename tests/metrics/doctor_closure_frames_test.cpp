#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "metrics/doctor/graph_checks.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::doctor_closure_frames_test {
namespace {

using namespace metrics;
using testing::HasSubstr;

TEST(DoctorOfClosures, NamesTheAxesOfAnotherBody) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.closures.clear();
  const Pose body{Rotation(Matrix3{{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}), Vector3::Zero()};
  const Matrix6 information = problem.odometry[0].information;
  for (std::size_t i = 0; i + 40 < 120; i += 4) {
    const Pose loop = problem.keyframes[i].world_from_body.inverse() *
                      problem.keyframes[i + 40].world_from_body *
                      exp_se3(0.01 * twist({std::sin(7.0 * double(i)), 0, 1}, {0, 1, 0}));
    problem.closures.push_back({i, i + 40, body.inverse() * loop * body, information});
  }
  const auto found = check_closures(problem);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::closure_frame);
  EXPECT_THAT(found[0].evidence, HasSubstr("taking z,-x,-y of the closures' body"));
}

/// Vertices and edges were written in the same wrong order.
TEST(DoctorOfClosures, OrderOfAllQuaternions) {
  Problem problem = test::walk(5, 120, 0.01);
  const auto misread = [](Pose& pose) {
    const Rotation q = pose.rotation;
    pose.rotation = Rotation(q.z(), q.w(), q.x(), q.y());
  };
  for (auto& [stamp, pose] : problem.keyframes) misread(pose);
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) misread(edge.from_from_to);
  }
  const auto found = check_closures(problem);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::quaternion_order);
}

/// The vertices decide where the odometry is no chain.
TEST(DoctorOfClosures, AreComparedWithTheVertices) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.odometry.erase(problem.odometry.begin() + 60);
  EXPECT_THAT(check_closures(problem), testing::IsEmpty());
  for (Edge& edge : problem.closures) edge.from_from_to = edge.from_from_to.inverse();
  const auto found = check_closures(problem);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::closure_direction);
}

/// A place recogniser without registration states the identity.
TEST(DoctorOfClosures, WithoutMeasuredPoses) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.closures.clear();
  for (std::size_t i = 0; i + 60 < 120; i += 6) {
    problem.closures.push_back({i, i + 60, Pose{}, problem.odometry[0].information});
  }
  const auto found = check_closures(problem);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::closure_gap);
  EXPECT_THAT(found[0].evidence, HasSubstr("10 of 10 closures state exactly the same pose"));
}

TEST(DoctorOfClosures, InvertedRotationsOrFeet) {
  const Problem good = test::walk(5, 120, 0.01);
  EXPECT_THAT(check_closures(good), testing::IsEmpty());
  Problem rotated = good, in_feet = good;
  for (Edge& edge : rotated.closures) {
    edge.from_from_to.rotation = edge.from_from_to.rotation.conjugate();
  }
  for (Edge& edge : in_feet.closures) edge.from_from_to.translation /= 0.3048;
  const auto found = check_closures(rotated);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].fault, Fault::closure_rotation);
  const auto unit = check_closures(in_feet);
  ASSERT_EQ(unit.size(), 1u);
  EXPECT_EQ(unit[0].fault, Fault::closure_unit);
  EXPECT_THAT(unit[0].evidence, HasSubstr("by 0.3048"));
}

}  // namespace
}  // namespace loopbench::doctor_closure_frames_test
