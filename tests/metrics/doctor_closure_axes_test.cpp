#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "datasets/core/mirrored.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::doctor_closure_axes_test {
namespace {

using namespace metrics;
using testing::ElementsAre;
using testing::IsEmpty;

/// Findings after a change of each closure.
std::vector<Fault::Name> faults_after(const std::function<void(Edge&, const Problem&)>& change) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.closures.clear();
  for (std::size_t i = 0; i + 40 < 120; i += 4) {
    const Pose loop =
        problem.keyframes[i].world_from_body.inverse() * problem.keyframes[i + 40].world_from_body;
    problem.closures.push_back({i, i + 40, loop, problem.odometry[0].information});
  }
  for (Edge& edge : problem.closures) change(edge, problem);
  std::vector<Fault::Name> out;
  for (const InputFinding& finding : check_closures(problem)) out.push_back(finding.fault);
  return out;
}

const Pose& world(const Problem& problem, std::size_t keyframe) {
  return problem.keyframes[keyframe].world_from_body;
}

TEST(DoctorOfClosures, TranslationsInTheWorld) {
  EXPECT_THAT(faults_after([](Edge&, const Problem&) {}), IsEmpty());
  EXPECT_THAT(faults_after([](Edge& edge, const Problem& problem) {
                Pose& pose = edge.from_from_to;
                pose.translation = world(problem, edge.from).rotation * pose.translation;
              }),
              ElementsAre(Fault::closure_frame));
}

TEST(DoctorOfClosures, PosesInTheWorld) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem& problem) {
                edge.from_from_to = world(problem, edge.to);
              }),
              ElementsAre(Fault::closure_frame));
}

TEST(DoctorOfClosures, LeftHandedAxes) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem&) {
                edge.from_from_to = mirrored(edge.from_from_to, 1);
              }),
              ElementsAre(Fault::closure_frame));
}

/// Readers turn a loop around whose first stamp is the later one.
TEST(DoctorOfClosures, MisreadRotationsOfLoopsFromTheLaterPose) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem&) {
                Pose as_listed = edge.from_from_to.inverse();
                const Rotation q = as_listed.rotation;
                as_listed.rotation = Rotation(q.z(), q.w(), q.x(), q.y());
                edge.from_from_to = as_listed.inverse();
              }),
              ElementsAre(Fault::closure_rotation));
}

TEST(DoctorOfClosures, WithoutRotations) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem&) {
                edge.from_from_to.rotation = Rotation::Identity();
              }),
              ElementsAre(Fault::closure_rotation));
}

TEST(DoctorOfClosures, SomeAreInverted) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem&) {
                if (edge.from % 12 == 0) edge.from_from_to = edge.from_from_to.inverse();
              }),
              ElementsAre(Fault::closure_direction));
}

TEST(DoctorOfClosures, OfOtherVertices) {
  EXPECT_THAT(faults_after([](Edge& edge, const Problem&) { edge.from += 17; }),
              ElementsAre(Fault::closure_gap));
}

TEST(DoctorOfClosures, InvertedOdometryOfAPlanarCar) {
  Problem problem;
  const auto pose = [](double i) -> Pose {  // twice around, wider and wider
    const double angle = 2 * M_PI * i / 60.0, radius = 20.0 + 0.1 * i;
    return {exp_so3({0, 0, angle}), {radius * std::sin(angle), -radius * std::cos(angle), 0}};
  };
  Matrix6 information = Matrix6::Identity();
  information.diagonal() << 1e4, 1e4, 1e4, 1e6, 1e6, 1e6;
  for (std::size_t i = 0; i < 121; ++i) {
    const Pose start = pose(0);
    problem.keyframes.push_back({static_cast<double>(i), start});
    if (i == 0) continue;
    const Pose step = pose(double(i) - 1).inverse() * pose(double(i));
    const Pose backwards = step.inverse();
    problem.keyframes.back().world_from_body = problem.keyframes[i - 1].world_from_body * backwards;
    problem.odometry.push_back({i - 1, i, backwards, information});
    if (i < 40 || i % 2 == 1) continue;
    const Pose loop = pose(double(i) - 40).inverse() * pose(double(i));
    problem.closures.push_back({i - 40, i, loop, information});
  }
  const auto found = check_closures(problem);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].fault, Fault::odometry_direction);
}

}  // namespace
}  // namespace loopbench::doctor_closure_axes_test
