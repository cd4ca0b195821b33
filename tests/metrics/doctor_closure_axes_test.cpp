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

struct Change {
  const char* name;
  std::function<void(Edge&, const Problem&)> change;
  std::vector<Fault::Name> faults;
};

TEST(DoctorOfClosures, ConventionsOfClosures) {
  const Change changes[] = {
      {"none", [](Edge&, const Problem&) {}, {}},
      {"left-handed axes",
       [](Edge& edge, const Problem&) { edge.from_from_to = mirrored(edge.from_from_to, 1); },
       {Fault::closure_convention}},
      // Readers turn a loop around whose first stamp is the later one.
      {"misread rotations of loops from the later pose",
       [](Edge& edge, const Problem&) {
         edge.from_from_to = test::misordered(edge.from_from_to.inverse()).inverse();
       },
       {Fault::closure_convention}},
  };
  for (const auto& [name, change, expected] : changes) {
    EXPECT_EQ(faults_after(change), expected) << name;
  }
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
  const InputFinding found = only(check_closures(problem), Fault::closure_convention);
  EXPECT_THAT(found.evidence, HasSubstr("taking z,-x,-y as x,y,z in the body of the closures"));
}

/// A place recogniser without registration states the identity.
TEST(DoctorOfClosures, WithoutMeasuredPoses) {
  Problem problem = test::walk(5, 120, 0.01);
  problem.closures.clear();
  for (std::size_t i = 0; i + 60 < 120; i += 6) {
    problem.closures.push_back({i, i + 60, Pose{}, problem.odometry[0].information});
  }
  const InputFinding found = only(check_closures(problem), Fault::placeholders);
  EXPECT_THAT(found.evidence, HasSubstr("10 of 10 closures state exactly the same pose"));
}

TEST(DoctorOfClosures, InvertedRotations) {
  const Problem good = test::walk(5, 120, 0.01);
  EXPECT_THAT(check_closures(good), testing::IsEmpty());
  Problem rotated = good;
  for (Edge& edge : rotated.closures) edge.from_from_to = test::conjugated(edge.from_from_to);
  only(check_closures(rotated), Fault::closure_convention);
}

}  // namespace
}  // namespace loopbench::doctor_closure_axes_test
