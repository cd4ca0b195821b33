#include "methods/smoothers/tracked_frames.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/uniform.hpp"
#include "methods/pipeline.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::tracked_frames_test {

using namespace methods;

namespace {

using namespace test;

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
}  // namespace loopbench::tracked_frames_test
