#include "methods/correctors/two_pass.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "methods/correctors/chain.hpp"
#include "methods/correctors/dual.hpp"
#include "methods/correctors/elch.hpp"
#include "methods/correctors/uniform.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::two_pass_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Steps of 1 m along x without rotation, and one closure from the first to the last keyframe.
Problem straight(int steps, const Pose& measured) {
  std::vector<double> positions;
  for (int i = 0; i <= steps; ++i) positions.push_back(i);
  Problem out = test::along_x(positions);
  out.closures.push_back({0, std::size_t(steps), measured, Matrix6::Identity()});
  return out;
}

Problem overlapping() {
  return test::drifting(test::hand_held_truth(60),
                        twist({0.002, -0.001, 0.003}, {0.001, 0.002, 0.01}),
                        {{5, 30}, {10, 45}, {2, 57}});
}

TEST(TwoPass, RotatesTheLaterStepsAndThenDistributesTheShift) {
  // Two steps: the first keyframe after the start rotates by 45 degrees, so the second step points
  // there. The chain then ends at (1 + r, r) with r = sqrt(1/2); if the closure measures exactly
  // that, no shift remains.
  const double r = std::sqrt(0.5);
  const Problem problem = straight(2, {exp_so3({0, 0, kPi / 2}), Vector3(1.0 + r, r, 0.0)});
  const Trajectory out = corrected<TwoPass>(problem);
  EXPECT_POSE_NEAR(out[1].world_from_body, {exp_so3({0, 0, kPi / 4}), {1, 0, 0}}, 1e-12, 1e-12);
  EXPECT_POSE_NEAR(out[2].world_from_body, problem.closures[0].from_from_to, 1e-12, 1e-12);

  // An additional shift of (0, 0, 3) is distributed evenly.
  Problem lifted = problem;
  lifted.closures[0].from_from_to.translation.z() = 3.0;
  EXPECT_NEAR(corrected<TwoPass>(lifted)[1].world_from_body.translation.z(), 1.5, 1e-12);
}

TEST(TwoPass, DistributesScaleAsAPowerOfTheShareAndOnce) {
  // Four steps measured as 1, with a scale that grows by 16 = 2^4 over the loop: 1, 2, 4, 8.
  const auto loop = [](std::size_t from, std::size_t to, double length, double scale) {
    return Edge{
        from, to, {Rotation::Identity(), Vector3(length, 0, 0)}, Matrix6::Identity(), scale};
  };
  Problem problem = straight(4, {});
  // The same loop once, as two halves, each in the scale at its start, and twice: the second half
  // is 1 + 2.
  const std::vector<std::vector<Edge>> cases{{loop(0, 2, 3, 4), loop(2, 4, 3, 4)},
                                             {loop(0, 4, 15, 16), loop(0, 4, 15, 16)},
                                             {loop(0, 4, 15, 16)}};
  for (const std::vector<Edge>& closures : cases) {
    problem.closures = closures;
    expect_positions(corrected<TwoPass>(problem), {0.0, 1.0, 3.0, 7.0, 15.0}, 1e-9);
  }
  // A loop whose scale is unknown takes the scale that earlier loops gave the path.
  Edge unknown = loop(0, 4, 7.5, 1);
  unknown.scale_information = 1e-6;
  problem.closures = {loop(0, 2, 3, 4), unknown};
  const Trajectory open = corrected<TwoPass>(problem);
  problem.closures[1] = loop(0, 4, 7.5, 4);
  const Trajectory stated = corrected<TwoPass>(problem);
  for (std::size_t k = 0; k < open.size(); ++k)
    EXPECT_POSE_NEAR(open[k].world_from_body, stated[k].world_from_body, 1e-12, 1e-12);
  problem.closures = {unknown};
  EXPECT_TRUE(has_scale_drift(problem));

  problem.closures = {loop(0, 4, 15, 16)};
  const Trajectory rigid = corrected<TwoPass>(problem, {.scale = false});
  EXPECT_NEAR(rigid[1].world_from_body.translation.x(), 3.75, 1e-12);
}

TEST(TwoPass, HasOwnWeightsForRotationAndTranslation) {
  // Steps of 1 and 3 m: the first is half of the steps, or a quarter of the distance.
  Problem problem = along_x({0, 1, 4});
  problem.closures.push_back({0, 2, {exp_so3({0, 0, kPi / 2}), {0, 0, 4}}});
  const auto expect = [&](const TwoPass::Options& options, double yaw, double z) {
    const Pose middle = corrected<TwoPass>(problem, options)[1].world_from_body;
    EXPECT_NEAR(log_so3(middle.rotation).z(), yaw, 1e-12);
    EXPECT_NEAR(middle.translation.z(), z, 1e-12);
  };
  expect({}, kPi / 4, 2.0);
  expect({.rotation_weights = StepWeights::distance}, kPi / 8, 2.0);
  expect({.translation_weights = StepWeights::distance}, kPi / 4, 1.0);
}

TEST(TwoPass, MovesTheTailRigidly) {
  Problem problem = straight(6, {});
  problem.closures = {{0, 2, {exp_so3({0, 0, kPi / 2}), Vector3(1, 1, 0)}, Matrix6::Identity()}};
  const Trajectory out = corrected<TwoPass>(problem);
  EXPECT_POSE_NEAR(out[6].world_from_body, {exp_so3({0, 0, kPi / 2}), {1, 5, 0}}, 1e-9, 1e-9);
}

TEST(TwoPass, OpenKeepsAllLoopsClosedWholeOnlyTheLast) {
  const Problem problem = overlapping();
  const Trajectory open = corrected<TwoPass>(problem, {.overlap = LoopOverlap::open});
  for (const Edge& loop : problem.closures) EXPECT_NEAR(closing_error(loop, open), 0.0, 1e-9);
  const Trajectory whole = corrected<TwoPass>(problem);
  EXPECT_NEAR(closing_error(problem.closures.back(), whole), 0.0, 1e-9);
  EXPECT_GT(closing_error(problem.closures.front(), whole), 1e-3);
}

TEST(TwoPass, EqualsMaximumLikelihoodForOneExactLoop) {
  // Isotropic equal steps and an exact closure: the closed-form solution also distributes rotation
  // evenly, so the two differ only by the lever arm. For a pure shift on a straight line without
  // rotation there is none, so they agree exactly.
  Problem problem = straight(8, {Rotation::Identity(), Vector3(8.2, 0.1, -0.05)});
  for (Edge& step : problem.odometry) {
    step.information.bottomRightCorner<3, 3>() *= 1e12;  // no rotation
  }
  problem.closures[0].information *= 1e12;
  test::expect_close(corrected<TwoPass>(problem), corrected<Dual>(problem), 1e-6);
}

TEST(TwoPass, RejectsUnsortedClosures) {
  Problem problem = straight(6, {});
  problem.closures = {{0, 5, {}, Matrix6::Identity()}, {0, 3, {}, Matrix6::Identity()}};
  EXPECT_THROW(corrected<TwoPass>(problem), std::runtime_error);
  problem.closures.clear();
  EXPECT_EQ(TwoPass({}).why_declined(problem), "the problem has no loop closures");
}

TEST(Elch, EqualsUniformForOneLoop) {
  const Problem problem = test::drifting(
      test::hand_held_truth(50), twist({0.002, 0.001, 0.003}, {0.001, 0.002, 0.01}), {{5, 40}});
  expect_close(corrected<Elch>(problem), corrected<Uniform>(problem), 1e-9);
}

TEST(Elch, UsesTheShortcutOfAnEarlierLoop) {
  // Positions 0 .. 8 along x. The first loop joins 6 to 0 without error; the second, 0 -> 8, has an
  // error of 3 m. Its shortest path is 0 - 6 - 7 - 8, so 6, 7, 8 move by 1, 2, 3 m, and 1 .. 5 move
  // with the nearer end.
  Problem problem = along_x({0, 1, 2, 3, 4, 5, 6, 7, 8});
  problem.closures = {{0, 6, at_x(6.0)}, {0, 8, {Rotation::Identity(), {8, 3, 0}}}};
  const Trajectory out = corrected<Elch>(problem);
  const double expected[] = {0, 0, 0, 0, 1, 1, 1, 2, 3};
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (i == 3) continue;  // equally far from 0 and 6
    EXPECT_NEAR(out[i].world_from_body.translation.y(), expected[i], 1e-12) << i;
  }
}

TEST(Elch, ClosesItsLastLoop) {
  const Problem problem = overlapping();
  EXPECT_NEAR(closing_error(problem.closures.back(), corrected<Elch>(problem)), 0.0, 1e-9);
}

}  // namespace
}  // namespace loopbench::test::two_pass_test
