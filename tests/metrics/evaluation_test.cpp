#include "metrics/evaluation.hpp"

#include <gtest/gtest.h>

#include "datasets/core/polyline.hpp"
#include "support.hpp"

namespace loopbench {
namespace {

using test::why;

/// One pose per stamp at x = stamp.
Trajectory at(const std::vector<double>& stamps) {
  Trajectory out;
  for (const double stamp : stamps) out.push_back({stamp, {Rotation::Identity(), {stamp, 0, 0}}});
  return out;
}

const Protocol kPlain{.max_diff = 0.1, .align = Align::none};

TEST(Evaluation, CountsPairsPossibleAndSpan) {
  // Reference lasts 8 s; the estimate is judged from 2 to 6 s and loses one pose in the hole.
  const Evaluation got = evaluate(at({0, 1, 2, 3, 5, 6, 7, 8}), at({2, 3, 4, 5, 6.05}), kPlain);
  EXPECT_EQ(got.coverage.pairs, 4u);
  EXPECT_EQ(got.coverage.possible, 5u);
  EXPECT_EQ(got.coverage.share(), 0.8);
  EXPECT_EQ(got.coverage.span, 0.5);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{2, 3, 5, 6}));
  EXPECT_EQ(stamps(got.estimate), (std::vector<double>{2, 3, 5, 6.05}));
  EXPECT_EQ(got.estimate[3].world_from_body.translation.x(), 6.05);
}

TEST(Evaluation, MovesTheEstimateOntoTheReference) {
  std::mt19937_64 random(1);
  const Trajectory reference = test::random_walk(random, 60);
  const Trajectory estimate = test::moved_by(test::random_pose(random, 3.0, 1.0), 0.5, reference);
  const Evaluation got = evaluate(reference, estimate, {.align = Align::sim3});
  EXPECT_NEAR(got.alignment.scale, 2.0, 1e-12);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_TRUE(
        is_close(got.estimate[i].world_from_body, reference[i].world_from_body, 1e-12, 1e-12));
  }
}

TEST(Evaluation, SaysWhatDidNotMeet) {
  EXPECT_EQ(why<std::runtime_error>([] {
              evaluate(at({0, 1}), at({5, 6.5}), kPlain);
            }),
            "no pose of the estimate (5.0 .. 6.5 s, offset 0.0 s) matches the reference (0.0 .. "
            "1.0 s): association nearest wants at most 0.1 s apart");
  const Protocol interpolating{
      .association = Association::interpolate, .max_gap = 0.5, .align = Align::none};
  EXPECT_EQ(why<std::runtime_error>([&] {
              evaluate(at({0, 1}), at({0.5}), interpolating);
            }),
            "no pose of the estimate (0.5 .. 0.5 s, offset 0.0 s) matches the reference (0.0 .. "
            "1.0 s): association interpolate wants a reference gap of at most 0.5 s");
  EXPECT_EQ(why<std::runtime_error>([] { evaluate({}, at({0}), kPlain); }),
            "the reference has no poses");
  EXPECT_EQ(why<std::runtime_error>([] { evaluate(at({0}), {}, kPlain); }),
            "the estimate has no poses");
}

TEST(Evaluation, SaysThatTheAlignmentIsDegenerate) {
  const Trajectory straight = at({0, 1, 2, 3});
  EXPECT_THROW(evaluate(straight, straight, {.align = Align::se3}), std::runtime_error);
}

TEST(Evaluation, JudgesACurveAtItsKeyframes) {
  const Polyline curve(at({1, 2, 4}));
  const Evaluation got =
      evaluate(at({0, 1, 2, 3, 4, 5}), curve, {1, 2, 4}, Times::keyframes, kPlain);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(got.coverage.possible, 3u);
  EXPECT_EQ(got.coverage.span, 0.6);
}

TEST(Evaluation, JudgesACurveAtEveryReferenceStampInsideItsSpan) {
  const Polyline curve(at({1, 2, 4}));
  const Evaluation got = evaluate(at({0, 1, 2.5, 3, 4, 5}), curve, {}, Times::dense, kPlain);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{1, 2.5, 3, 4}));
  EXPECT_EQ(got.coverage.pairs, 4u);
  EXPECT_EQ(got.coverage.possible, 4u);
  EXPECT_EQ(got.coverage.span, 0.6);
  EXPECT_NEAR(got.estimate[1].world_from_body.translation.x(), 2.5, 1e-15);
}

TEST(Evaluation, OffsetMovesTheEstimatesClockAlsoDensely) {
  const Polyline curve(at({1, 4}));
  Protocol later = kPlain;
  later.offset = 0.5;
  const Evaluation got = evaluate(at({0, 1, 2, 3, 4, 5}), curve, {}, Times::dense, later);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{2, 3, 4}));
  EXPECT_EQ(got.estimate[0].world_from_body.translation.x(), 1.5);
}

TEST(Evaluation, SaysThatNoReferenceLiesOnTheCurve) {
  const Polyline curve(at({10, 11}));
  EXPECT_EQ(why<std::runtime_error>([&] {
              evaluate(at({0, 1}), curve, {}, Times::dense, kPlain);
            }),
            "no reference stamp (0.0 .. 1.0 s) lies on the curve (10.0 .. 11.0 s, offset 0.0 s)");
}

}  // namespace
}  // namespace loopbench
