#include "methods/smoothers/tracked_frames.hpp"

#include <gtest/gtest.h>

#include "methods/correctors/uniform.hpp"
#include "methods/pipeline.hpp"
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
    for (const auto& [stamp, pose] : *part) {
      EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-12, 1e-12)) << stamp;
    }
  }
  ASSERT_FALSE(report.counts.empty());
  EXPECT_EQ(report.counts.front().name, "frames");
  EXPECT_EQ(report.counts.front().value, static_cast<double>(problem.frames.size()));
}

TEST(TrackedFrames, StayAttachedToCorrectedKeyframes) {
  const Problem problem = hand_held();
  const Uniform uniform{Uniform::Options{}};
  Report report;
  const Trajectory corrected = uniform.correct(problem, report);
  const Problem moved_problem = with_keyframes(problem, corrected);
  const auto curve =
      tracked(std::make_unique<Uniform>(Uniform::Options{}))->estimate(problem, report);
  for (const auto& [stamp, pose] : corrected) {
    EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-12, 1e-12)) << stamp;
  }
  ASSERT_EQ(moved_problem.frames.size(), problem.frames.size());
  double moved = 0.0;
  for (std::size_t i = 0; i < moved_problem.frames.size(); ++i) {
    const auto& [stamp, pose] = moved_problem.frames[i];
    EXPECT_TRUE(is_close(curve->at(stamp), pose, 1e-12, 1e-12)) << stamp;
    moved =
        std::max(moved, (pose.translation - problem.frames[i].world_from_body.translation).norm());
  }
  EXPECT_GT(moved, 0.01);
}

}  // namespace
}  // namespace loopbench::tracked_frames_test
