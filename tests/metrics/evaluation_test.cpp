#include "metrics/evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include "datasets/core/polyline.hpp"
#include "support.hpp"
#include "tests/support/tolerance.hpp"

namespace loopbench::test::evaluation_test {
namespace {

/// One pose per stamp at x = stamp.
Trajectory at(const std::vector<double>& stamps) {
  Trajectory out;
  for (const double stamp : stamps) out.push_back({stamp, {Rotation::Identity(), {stamp, 0, 0}}});
  return out;
}

const Protocol kPlain{.max_diff = 0.1, .align = Align::none};

TEST(Evaluation, CountsPairsPossibleAndSpan) {
  // The reference lasts 8 s; the estimate is evaluated from 2 to 6 s and one pose lies in the gap.
  const Evaluation got = evaluate(at({0, 1, 2, 3, 5, 6, 7, 8}), at({2, 3, 4, 5, 6.05}), kPlain);
  EXPECT_EQ(got.coverage.pairs, 4u);
  EXPECT_EQ(got.coverage.possible, 5u);
  EXPECT_EQ(got.coverage.share(), 0.8);
  EXPECT_EQ(got.coverage.span, 0.5);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{2, 3, 5, 6}));
  EXPECT_EQ(stamps(got.estimate), (std::vector<double>{2, 3, 5, 6.05}));
  EXPECT_EQ(got.estimate[3].world_from_body.translation.x(), 6.05);
}

/// Stamps from `first` to `last`, `step` apart, all exact in binary.
std::vector<double> every(double step, double first, double last) {
  std::vector<double> out;
  for (double stamp = first; stamp <= last; stamp += step) out.push_back(stamp);
  return out;
}

std::vector<double> ends(double step) {
  std::vector<double> out = every(step, 0.0, 3.5);
  for (const double stamp : every(step, 36.5, 40.0)) out.push_back(stamp);
  return out;
}

TEST(Evaluation, TimeLostIsNotEvaluated) {
  const auto span = [](const Trajectory& reference, const Trajectory& estimate) {
    return evaluate(reference, estimate, kPlain).coverage.span;
  };
  const Trajectory complete = at(every(0.5, 0.0, 40.0));
  EXPECT_EQ(span(complete, complete), 1.0);
  EXPECT_EQ(span(complete, at(ends(0.5))), 7.0 / 40.0);        // no poses from 3.5 to 36.5 s
  EXPECT_EQ(span(at(ends(0.5)), complete), 1.0);               // gap of the reference itself
  EXPECT_EQ(span(complete, at(every(4.0, 0.0, 40.0))), 1.0);   // keyframes 4 s apart everywhere
  EXPECT_EQ(span(complete, at(every(10.0, 0.0, 40.0))), 0.5);  // 10 s apart: 5 s of each interval
  EXPECT_EQ(span(at(every(10.0, 0.0, 40.0)), complete), 1.0);  // so is the reference itself
  Trajectory standing = complete;
  for (auto& [stamp, pose] : standing) pose.translation.x() = stamp < 20.0 ? 0.0 : 1.0;
  EXPECT_EQ(span(standing, at(ends(0.5))), 1.0);  // 1 m in 33 s: at rest, no keyframes expected
}

TEST(Evaluation, ABridgedTrackingGapIsNotEvaluated) {
  const Trajectory complete = at(every(0.5, 0.0, 40.0));
  const std::vector<double> keyframes = ends(0.5);  // none from 3.5 to 36.5 s
  const Polyline chord(at(keyframes));
  const auto evaluated = [&](const Protocol& rules, const std::vector<double>& tracked = {}) {
    return evaluate(complete, chord, keyframes, Times::dense, rules, tracked).coverage;
  };
  const Coverage limited = evaluated(kPlain);
  EXPECT_EQ(limited.pairs, keyframes.size());
  EXPECT_EQ(limited.possible, complete.size());
  EXPECT_EQ(limited.span, 7.0 / 40.0);
  EXPECT_EQ(limited.bridged, 33.0);

  Protocol any = kPlain;
  any.max_estimate_gap = 0.0;
  const Coverage all = evaluated(any);
  EXPECT_EQ(all.pairs, complete.size());
  EXPECT_EQ(all.span, 1.0);
  EXPECT_EQ(all.bridged, 33.0);
  Protocol longer = kPlain;
  longer.max_estimate_gap = 34.0;
  EXPECT_EQ(evaluated(longer).bridged, 0.0);

  const Coverage tracked = evaluated(kPlain, stamps(complete));  // frames between the keyframes
  EXPECT_EQ(tracked.pairs, complete.size());
  EXPECT_EQ(tracked.bridged, 0.0);
}

TEST(Evaluation, SparseKeyframesAreNoTrackingGap) {
  const Trajectory complete = at(every(0.5, 0.0, 40.0));
  const std::vector<double> keyframes = every(4.0, 0.0, 40.0);
  const Coverage got =
      evaluate(complete, Polyline(at(keyframes)), keyframes, Times::dense, kPlain).coverage;
  EXPECT_EQ(got.share(), 1.0);
  EXPECT_EQ(got.bridged, 0.0);
}

/// A quarter circle with constant or tangential orientation.
Trajectory bend(bool turns) {
  Trajectory out;
  for (int i = 0; i < 20; ++i) {
    const double angle = 0.08 * i;
    out.push_back({1.0 * i,
                   {exp_so3({0.0, 0.0, turns ? angle : 0.0}),
                    {std::sin(angle), 1.0 - std::cos(angle), 0.0}}});
  }
  return out;
}

TEST(Evaluation, AFirstPoseWithoutAttitudeAlignsNothing) {
  for (const Align align : {Align::origin, Align::posyaw_origin}) {
    EXPECT_EQ(
        why<std::runtime_error>([&] { evaluate(bend(false), bend(true), {.align = align}); }),
        "alignment " + to_text(align) +
            ": the reference has a constant orientation although its path is curved: it holds only "
            "positions, so its first pose does not define a rotation; align by se3, sim3, posyaw "
            "or none");
    EXPECT_NO_THROW(evaluate(bend(true), bend(true), {.align = align}));
    EXPECT_NO_THROW(evaluate(bend(false), bend(false), {.align = align}));
  }
  EXPECT_NO_THROW(evaluate(bend(false), bend(true), {.align = Align::se3}));
}

TEST(Evaluation, CoordinatesBeyondDoublesSquaresAreToldSo) {
  Trajectory far = bend(true);
  far[3].world_from_body.translation.x() = 1e160;
  EXPECT_EQ(why<std::runtime_error>([&] { evaluate(bend(true), far, Protocol{}); }),
            "alignment se3: 20 pairs are too far apart for double precision, so the rotation is "
            "not unique; use align = origin or none");
}

TEST(Evaluation, SaysWhatDidNotMeet) {
  EXPECT_EQ(why<std::runtime_error>([] {
              evaluate(at({0, 1}), at({5, 6.5}), kPlain);
            }),
            "no pose of the estimate (5.0 .. 6.5 s, offset 0.0 s) matches the reference (0.0 .. "
            "1.0 s): association nearest accepts differences of at most 0.1 s");
  const Protocol interpolating{
      .association = Association::interpolate, .max_gap = 0.5, .align = Align::none};
  EXPECT_EQ(why<std::runtime_error>([&] {
              evaluate(at({0, 1}), at({0.5}), interpolating);
            }),
            "no pose of the estimate (0.5 .. 0.5 s, offset 0.0 s) matches the reference (0.0 .. "
            "1.0 s): association interpolate accepts reference gaps of at most 0.5 s");
  EXPECT_EQ(why<std::runtime_error>([] { evaluate({}, at({0}), kPlain); }),
            "the reference has no poses");
  EXPECT_EQ(why<std::runtime_error>([] { evaluate(at({0}), {}, kPlain); }),
            "the estimate has no poses");
}

TEST(Evaluation, EvaluatesACurveAtItsKeyframes) {
  const Polyline curve(at({1, 2, 4}));
  const Evaluation got =
      evaluate(at({0, 1, 2, 3, 4, 5}), curve, {1, 2, 4}, Times::keyframes, kPlain);
  EXPECT_EQ(stamps(got.reference), (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(got.coverage.possible, 3u);
  EXPECT_EQ(got.coverage.span, 0.6);
}

TEST(Evaluation, EvaluatesACurveAtEveryReferenceStampInsideItsSpan) {
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
}  // namespace loopbench::test::evaluation_test
