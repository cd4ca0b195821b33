#include "methods/pipeline.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/uniform.hpp"
#include "methods/function_method.hpp"
#include "methods/smoothers/interpolating_splines.hpp"
#include "methods/smoothers/tracked_frames.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::test::pipeline_test {
namespace {

TEST(WithKeyframes, FramesFollowARigidMotion) {
  const Problem before = hand_held();
  const Pose motion{exp_so3({0.5, 0.2, -0.9}), {3.0, 2.0, 1.0}};
  const Problem moved = moved_by(motion, before);
  const Problem after = with_keyframes(before, moved.keyframes);
  expect_close(after.frames, moved.frames, 1e-12);
}

TEST(WithKeyframes, FramesInterpolateTheirNeighboursByTime) {
  Problem before;
  before.keyframes = {{0.0, {}}, {4.0, {Rotation::Identity(), {4.0, 0.0, 0.0}}}};
  before.frames = {{1.0, {Rotation::Identity(), {1.0, 0.1, 0.0}}}};
  Trajectory lifted = before.keyframes;
  lifted[1].world_from_body.translation.z() = 2.0;
  const Problem after = with_keyframes(before, lifted);
  ASSERT_EQ(after.frames.size(), 1u);
  const Vector3 expected(1.0, 0.1, 0.5);  // a quarter of the time, so a quarter of the lift
  EXPECT_NEAR((after.frames[0].world_from_body.translation - expected).norm(), 0.0, 1e-15);
}

TEST(WithKeyframes, DropsFramesOutsideTheKeyframes) {
  Problem before;
  before.keyframes = {{1.0, {}}, {2.0, {}}};
  before.frames = {{0.5, {}}, {1.5, {}}, {2.5, {}}};
  EXPECT_EQ(stamps(with_keyframes(before, before.keyframes).frames), std::vector{1.5});
}

TEST(Compose, SmoothsTheCorrectedKeyframes) {
  const Problem problem = hand_held();
  const auto both = compose(std::make_unique<Uniform>(Uniform::Options{}),
                            std::make_unique<CubicSpline>(CubicSpline::Options{}));
  Report report;
  const auto curve = both->estimate(problem, report);
  const Trajectory expected = corrected<Uniform>(problem);
  expect_close(curve->sample(stamps(expected)), expected, 1e-10);
  ASSERT_EQ(report.phases.size(), 2u);
  EXPECT_EQ(report.phases[0].name, "correct");
  EXPECT_EQ(report.phases[1].name, "smooth");
}

TEST(Compose, DeclinesForEitherStage) {
  Problem problem = hand_held();
  problem.closures.clear();
  const auto both = compose(std::make_unique<Uniform>(Uniform::Options{}),
                            std::make_unique<CubicSpline>(CubicSpline::Options{}));
  EXPECT_EQ(both->why_declined(problem), "the problem has no loop closures");
  EXPECT_EQ(compose(nullptr, nullptr)->why_declined(Problem{}), "no keyframes");
  EXPECT_EQ(compose(nullptr, nullptr)->why_declined(problem), "");
}

std::unique_ptr<const Estimator> tracked(std::unique_ptr<const Corrector> corrector = nullptr) {
  return compose(std::move(corrector), std::make_unique<TrackedFrames>(TrackedFrames::Options{}));
}

TEST(TrackedFrames, AreInterpolatedBetweenKeyframes) {
  const Problem problem = hand_held();
  Report report;
  const auto curve = tracked()->estimate(problem, report);
  for (const Trajectory* part : {&problem.keyframes, &problem.frames}) {
    expect_close(curve->sample(stamps(*part)), *part, 1e-12);
  }
  ASSERT_FALSE(report.counts.empty());
  EXPECT_EQ(report.counts.front().name, "frames");
  EXPECT_EQ(report.counts.front().value, static_cast<double>(problem.frames.size()));
}

TEST(TrackedFrames, StayAttachedToCorrectedKeyframes) {
  const Problem problem = hand_held();
  const Trajectory keyframes = corrected<Uniform>(problem);
  const Problem moved_problem = with_keyframes(problem, keyframes);
  Report report;
  const auto curve =
      tracked(std::make_unique<Uniform>(Uniform::Options{}))->estimate(problem, report);
  for (const Trajectory& part : {keyframes, moved_problem.frames}) {
    expect_close(curve->sample(stamps(part)), part, 1e-12);
  }
  ASSERT_EQ(moved_problem.frames.size(), problem.frames.size());
  EXPECT_GT(largest_distance(moved_problem.frames, problem.frames), 0.01);
}

}  // namespace
}  // namespace loopbench::test::pipeline_test
