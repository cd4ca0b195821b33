/// Limits of smoothing and interpolation: headroom, floor, and their filters.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "datasets/core/cubic.hpp"
#include "datasets/formats/formats.hpp"
#include "metrics/correction/interpolation_floor.hpp"
#include "metrics/correction/smoothing_headroom.hpp"
#include "support.hpp"

namespace loopbench::headroom_test {

using namespace metrics;

namespace {

using test::find;
using test::why;

/// `n` poses, 1/64 s apart, with position error `error`.
template <class Error>
Evaluation straying(std::size_t n, Error error) {
  Evaluation out;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / 64.0;
    out.reference.push_back({t, {Rotation::Identity(), {t, 0.0, 0.0}}});
    out.estimate.push_back(out.reference.back());
    out.estimate.back().world_from_body.translation += error(t);
  }
  return out;
}

double gain(const Evaluation& evaluation, const SmoothingHeadroomOptions& options) {
  return find(smoothing_headroom(evaluation, options), "gain", "3d").mean;
}

/// Basis functions of the mirrored span, each a single line of the spectrum: slow 3 m, fast 4 m.
Evaluation slow_and_fast() {
  const double span = 1023.0 / 64.0;
  return straying(1024, [=](double t) {
    const double slow = 3.0 * std::cos(std::numbers::pi * 4.0 * t / span);   // period 8 s
    const double fast = 4.0 * std::cos(std::numbers::pi * 80.0 * t / span);  // period 0.4 s
    return Vector3(slow, 0.0, fast);
  });
}

TEST(SmoothingHeadroom, TakesFastWavesAwayAndLeavesSlowOnes) {
  const Evaluation e = slow_and_fast();
  const auto scores = smoothing_headroom(e, {.window = 1.0});
  // Linear interpolation of a sampled wave keeps (2 + cos phase step) / 3 of its power.
  const double slow = 0.5 * 9.0 * (2.0 + std::cos(std::numbers::pi * 4.0 / 1023.0)) / 3.0;
  const double fast = 0.5 * 16.0 * (2.0 + std::cos(std::numbers::pi * 80.0 / 1023.0)) / 3.0;
  EXPECT_NEAR(find(scores, "before", "3d").rmse, std::sqrt(slow + fast), 1e-3);
  EXPECT_NEAR(find(scores, "after", "3d").rmse, std::sqrt(slow), 1e-3);
  EXPECT_NEAR(gain(e, {.window = 1.0}), 100.0 * (1.0 - std::sqrt(slow / (slow + fast))), 0.03);
  EXPECT_NEAR(gain(e, {.window = 0.3}), 0.0, 1e-3);
  EXPECT_GT(gain(e, {.window = 10.0}), 99.0);
  EXPECT_NEAR(gain(e, {.window = 1.0, .filter = Filter::moving_average}), 40.0, 2.0);
}

TEST(SmoothingHeadroom, GrowsWithTheWindow) {
  std::mt19937_64 random(1);
  const Evaluation e = straying(1000, [&](double) { return test::random_vector(random, 1.0); });
  double before = 0.0;
  for (const double window : {0.01, 0.05, 0.2, 1.0, 5.0, 100.0}) {
    const double now = gain(e, {.window = window});
    EXPECT_GE(now, before - 1e-12) << window;
    before = now;
  }
}

TEST(SmoothingHeadroom, ASteadyDriftGainsNothing) {
  const Evaluation e = straying(2000, [](double t) { return Vector3(0.1 * t, -0.2 * t, 1.0); });
  EXPECT_NEAR(gain(e, {.window = 1.0}), 0.0, 1e-2);
  EXPECT_NEAR(gain(e, {.window = 1.0, .filter = Filter::moving_average}), 0.0, 1e-10);
}

TEST(SmoothingHeadroom, RefusesNoErrorAndNoTime) {
  const auto none = [](double) { return Vector3::Zero().eval(); };
  EXPECT_EQ(why<std::runtime_error>([&] { smoothing_headroom(straying(10, none), {}); }),
            "smoothing_headroom: the error is zero");
  EXPECT_EQ(why<std::runtime_error>([&] { smoothing_headroom(straying(1, none), {}); }),
            "smoothing_headroom: needs two poses with different stamps");
}

TEST(SmoothingHeadroom, MovingAverageShrinksAtTheEndsAndBesideHoles) {
  const std::vector<double> errors{1, 4, 1, 9, 5, 8, 2};
  Evaluation e;
  for (const double stamp : {0.0, 1.0, 2.0, 3.0, 10.0, 11.0, 12.0}) {
    e.reference.push_back({stamp, {}});
    e.estimate.push_back({stamp, {Rotation::Identity(), {errors[e.estimate.size()], 0, 0}}});
  }
  const auto scores = smoothing_headroom(e, {.window = 2.0, .filter = Filter::moving_average});
  const Statistics after = find(scores, "after", "3d");  // 1, 2, 14 / 3, 9, 5, 5, 2
  EXPECT_EQ(after.max, 9.0);
  EXPECT_EQ(after.median, 14.0 / 3.0);
  EXPECT_NEAR(after.sse, 1.0 + 4.0 + 196.0 / 9.0 + 81.0 + 25.0 + 25.0 + 4.0, 1e-12);
}

// An independent cosine transform in another language gives 1.935, 4.617, 11.686 % on a grid of
// 2048; the remaining digits depend on the grid.
TEST(SmoothingHeadroom, OfRgbdslamOnRoomIsSmall) {
  const char* folder = std::getenv("LOOPBENCH_DATA");
  if (folder == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const std::filesystem::path room = std::filesystem::path(folder) / "tum_rgbd/fr1_room";
  if (!std::filesystem::exists(room)) GTEST_SKIP() << room << " is not there";
  const Evaluation e = evaluate(read_trajectory(room / "groundtruth.txt", {}),
                                read_trajectory(room / "rgbdslam_frames.txt", {}),
                                {});
  EXPECT_NEAR(find(smoothing_headroom(e, {}), "before", "3d").rmse, 0.101, 1e-3);
  EXPECT_NEAR(gain(e, {.window = 1.0}), 1.935, 0.05);
  EXPECT_NEAR(gain(e, {.window = 2.0}), 4.617, 0.05);
  EXPECT_NEAR(gain(e, {.window = 4.0}), 11.686, 0.05);
}

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
      "interpolation_floor: the reference has no pose between keyframes");
  EXPECT_THROW(interpolation_floor(Evaluation{}, {}), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::headroom_test
