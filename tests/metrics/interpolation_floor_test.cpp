/// Interpolation error of exact keyframes, and natural cubics.
#include "metrics/correction/interpolation_floor.hpp"

#include "datasets/core/cubic.hpp"
#include "support.hpp"

namespace loopbench::test::interpolation_floor_test {
namespace {

TEST(Cubic, ByHand) {
  // Second derivative 0, -3, 0 for a unit tent: s(1/2) = 1/2 + 3/16.
  const std::vector<double> stamps{0.0, 1.0, 2.0};
  const std::vector<double> tent{0.0, 1.0, 0.0};
  EXPECT_EQ(cubic_second_derivatives<double>(stamps, tent), (std::vector{0.0, -3.0, 0.0}));
  EXPECT_NEAR(
      (cubic_between<double, double>({0.0, 0.0, 0.0}, {1.0, 1.0, -3.0}, 0.5)), 0.6875, 1e-15);
  // The parabola through these values has the second derivative -2 if its velocities are given.
  const double start = 2.0;
  const double end = -2.0;
  const auto parabola = cubic_second_derivatives<double>(stamps, tent, &start, &end);
  for (const double value : parabola) EXPECT_NEAR(value, -2.0, 1e-14);
}

/// y = (t - 2)^2 for 4 s, 0.5 s apart, with estimate poses every second.
struct Parabola {
  Trajectory reference;
  Trajectory estimate;
  Evaluation evaluation;

  Parabola() {
    for (int k = 0; k <= 8; ++k) {
      const double t = 0.5 * k;
      reference.push_back({t, {exp_so3({0, 0, 0.2 * t}), {t, (t - 2) * (t - 2), 0.0}}});
      if (k % 2 == 0) estimate.push_back({t, {}});
    }
    evaluation.reference = reference;
    evaluation.estimate = reference;
    evaluation.context.reference = &reference;
    evaluation.context.estimate = &estimate;
  }
  Parabola(const Parabola&) = delete;
};

TEST(InterpolationFloor, ByHand) {
  const Parabola parabola;
  const auto scores = interpolation_floor(parabola.evaluation, {.max_gap = 0.6});
  const Statistics polyline = find(scores, "polyline", "3d");
  EXPECT_EQ(polyline.count, 9u);
  EXPECT_NEAR(polyline.sse, 4.0 * 0.25 * 0.25, 1e-14);  // sagitta of each chord
  // Second derivatives 0, 18/7, 12/7, 18/7, 0 at the nodes: 4 M1 + M2 = 12 = 2 M1 + 4 M2. At the
  // middle of an interval they pull the chord down by a sixteenth of their sum.
  const double outer = 0.25 - 18.0 / 7.0 / 16.0;
  const double inner = 0.25 - (18.0 + 12.0) / 7.0 / 16.0;
  EXPECT_NEAR(
      find(scores, "natural_cubic", "3d").sse, 2.0 * (outer * outer + inner * inner), 1e-13);
  EXPECT_NEAR(find(scores, "slerp", "3d").max, 0.0, 1e-12);  // constant angular velocity
}

TEST(InterpolationFloor, DoesNotJoinKeyframesAcrossAHoleInTheReference) {
  Parabola parabola;
  parabola.reference.erase(parabola.reference.begin() + 3, parabola.reference.begin() + 6);
  const auto scores = interpolation_floor(parabola.evaluation, {.max_gap = 0.6});
  EXPECT_EQ(find(scores, "polyline", "3d").count, 6u);  // 0 .. 1 s and 3 .. 4 s
  EXPECT_NEAR(find(scores, "natural_cubic", "3d").sse, 2.0 * 0.25 * 0.25, 1e-14);  // two chords
}

TEST(InterpolationFloor, RefusesAReferenceThatIsNoDenserThanTheKeyframes) {
  Parabola parabola;
  parabola.estimate = parabola.reference;
  EXPECT_EQ(
      why<std::runtime_error>([&] { interpolation_floor(parabola.evaluation, {.max_gap = 0.6}); }),
      "the reference has no pose between keyframes");
  EXPECT_THROW(interpolation_floor(Evaluation{}, {}), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::test::interpolation_floor_test
