/// Errors in per cent of the path, at its end, and of snippets, computed by hand.
#include "metrics/errors/drift.hpp"

#include <cmath>

#include "support.hpp"

namespace loopbench::test::drift_test {
namespace {

/// Straight ahead for 4 m in steps of 1 m; the estimate's steps are 10 % longer, and it rotates by
/// 0.1 rad at the end.
Evaluation straight() {
  Trajectory reference, estimate;
  for (int i = 0; i < 5; ++i) {
    const Rotation rotation = exp_so3({0, 0, i == 4 ? 0.1 : 0.0});
    reference.push_back({0.1 * i, {Rotation::Identity(), Vector3(i, 0, 0)}});
    estimate.push_back({0.1 * i, {rotation, Vector3(1.1 * i, 0, 0)}});
  }
  return evaluate(reference, estimate, {.align = Align::none, .min_pairs = 1});
}

TEST(Drift, IsTheErrorInPerCentOfThePath) {
  const Statistics found = find(drift(straight()), "translation", "3d");
  EXPECT_NEAR(found.max, 10.0, 1e-12);  // 0.4 m of 4 m
  EXPECT_NEAR(found.mean, 5.0, 1e-12);
}

TEST(EndError, IsThatOfTheMotionFromTheFirstToTheLastPose) {
  const auto scores = end_error(straight());
  EXPECT_NEAR(find(scores, "translation", "3d").mean, 0.4, 1e-12);
  EXPECT_NEAR(find(scores, "share", "3d").mean, 10.0, 1e-12);
  EXPECT_NEAR(find(scores, "rotation", "3d").mean, 0.1 * 180.0 / M_PI, 1e-10);
}

TEST(EndError, DoesNotDependOnTheWorld) {
  std::mt19937_64 random(1);
  const Trajectory reference = random_walk(random, 50);
  const Trajectory estimate = noisy(random, reference, 0.01, 0.01);
  const Protocol rules{.align = Align::none, .min_pairs = 1};
  const Pose world{exp_so3({0.3, -0.2, 1.0}), {5, 6, 7}};
  const double here =
      find(end_error(evaluate(reference, estimate, rules)), "translation", "3d").mean;
  const double there = find(end_error(evaluate(reference, moved_by(world, 1.0, estimate), rules)),
                            "translation",
                            "3d")
                           .mean;
  EXPECT_NEAR(here, there, 1e-9);
}

TEST(SnippetAte, HasAScaleOfItsOwn) {
  // A larger scale leaves nothing, apart from the rotation at the end, which is in no position.
  EXPECT_NEAR(find(snippet_ate(straight(), {}), "translation", "3d").max, 0.0, 1e-7);
  // Positions 0, 1, 2 and 0, 1, 3: s = 7 / 10, |a - s b|^2 = 5 - 49 / 10, over three frames.
  const Trajectory reference{{0, {{}, {0, 0, 0}}}, {1, {{}, {1, 0, 0}}}, {2, {{}, {2, 0, 0}}}};
  Trajectory estimate = reference;
  estimate[2].world_from_body.translation.x() = 3.0;
  Trajectory truth = reference;
  for (Trajectory* all : {&truth, &estimate}) {
    for (auto& [stamp, pose] : *all) pose.rotation = Rotation::Identity();
  }
  const Evaluation both = evaluate(truth, estimate, {.align = Align::none, .min_pairs = 1});
  EXPECT_NEAR(find(snippet_ate(both, {.frames = 3}), "translation", "3d").mean,
              std::sqrt(0.1) / 3.0,
              1e-12);
}

}  // namespace
}  // namespace loopbench::test::drift_test
