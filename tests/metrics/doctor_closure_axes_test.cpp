#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "datasets/core/mirrored.hpp"
#include "metrics/doctor/graph_checks.hpp"
#include "tests/metrics/doctor_pairs.hpp"
#include "tests/support/random_chain.hpp"

namespace loopbench::doctor_closure_axes_test {
namespace {

using namespace metrics;
using test::only;
using testing::HasSubstr;

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

struct Change {
  const char* name;
  std::function<void(Edge&, const Problem&)> change;
  std::vector<Fault::Name> faults;
};

TEST(DoctorOfClosures, ConventionsOfClosures) {
  const Change changes[] = {
      {"none", [](Edge&, const Problem&) {}, {}},
      {"translations in the world",
       [](Edge& edge, const Problem& problem) {
         Pose& pose = edge.from_from_to;
         pose.translation = world(problem, edge.from).rotation * pose.translation;
       },
       {Fault::closure_frame}},
      {"poses in the world",
       [](Edge& edge, const Problem& problem) { edge.from_from_to = world(problem, edge.to); },
       {Fault::closure_frame}},
      {"left-handed axes",
       [](Edge& edge, const Problem&) { edge.from_from_to = mirrored(edge.from_from_to, 1); },
       {Fault::closure_frame}},
      // Readers turn a loop around whose first stamp is the later one.
      {"misread rotations of loops from the later pose",
       [](Edge& edge, const Problem&) {
         edge.from_from_to = test::misordered(edge.from_from_to.inverse()).inverse();
       },
       {Fault::closure_rotation}},
      {"without rotations",
       [](Edge& edge, const Problem&) { edge.from_from_to.rotation = Rotation::Identity(); },
       {Fault::closure_rotation}},
      {"some inverted",
       [](Edge& edge, const Problem&) {
         if (edge.from % 12 == 0) edge.from_from_to = edge.from_from_to.inverse();
       },
       {Fault::closure_direction}},
      {"of other vertices",
       [](Edge& edge, const Problem&) { edge.from += 17; },
       {Fault::closure_gap}},
  };
  for (const auto& [name, change, expected] : changes) {
    EXPECT_EQ(faults_after(change), expected) << name;
  }
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
  const InputFinding found = only(check_closures(problem), Fault::closure_frame);
  EXPECT_THAT(found.evidence, HasSubstr("taking z,-x,-y of the closures' body"));
}

/// Vertices and edges were written in the same wrong order.
TEST(DoctorOfClosures, OrderOfAllQuaternions) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.keyframes = test::each(problem.keyframes, test::misordered);
  for (auto* edges : {&problem.odometry, &problem.closures}) {
    for (Edge& edge : *edges) edge.from_from_to = test::misordered(edge.from_from_to);
  }
  only(check_closures(problem), Fault::quaternion_order);
}

/// The vertices decide where the odometry is no chain.
TEST(DoctorOfClosures, AreComparedWithTheVertices) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.odometry.erase(problem.odometry.begin() + 60);
  EXPECT_THAT(check_closures(problem), testing::IsEmpty());
  for (Edge& edge : problem.closures) edge.from_from_to = edge.from_from_to.inverse();
  only(check_closures(problem), Fault::closure_direction);
}

/// A place recogniser without registration states the identity.
TEST(DoctorOfClosures, WithoutMeasuredPoses) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.closures.clear();
  for (std::size_t i = 0; i + 60 < 120; i += 6) {
    problem.closures.push_back({i, i + 60, Pose{}, problem.odometry[0].information});
  }
  const InputFinding found = only(check_closures(problem), Fault::closure_gap);
  EXPECT_THAT(found.evidence, HasSubstr("10 of 10 closures state exactly the same pose"));
}

TEST(DoctorOfClosures, InvertedRotationsOrFeet) {
  const Problem good = test::walk(5, 120, 0.01);
  EXPECT_THAT(check_closures(good), testing::IsEmpty());
  Problem rotated = good, in_feet = good;
  for (Edge& edge : rotated.closures) edge.from_from_to = test::conjugated(edge.from_from_to);
  for (Edge& edge : in_feet.closures) edge.from_from_to.translation /= 0.3048;
  only(check_closures(rotated), Fault::closure_rotation);
  const InputFinding unit = only(check_closures(in_feet), Fault::closure_unit);
  EXPECT_THAT(unit.evidence, HasSubstr("by 0.3048"));
}

}  // namespace
}  // namespace loopbench::doctor_closure_axes_test
