/// Scales of closures where a path shows them, and where none does.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/derive/closures.hpp"
#include "datasets/noise/random.hpp"

namespace loopbench::local_scale_test {
namespace {

/// A drone that flies along a curve, and hovers in between. Noise of 5 mm, a tenth of a step in
/// flight, is all that moves while it hovers; the run has twice the scale.
void hover(std::size_t in_flight, std::size_t at_rest, Trajectory& keyframes, Trajectory& run) {
  Random random({5, 1}, Purpose::closures);
  double t = 0.0;
  for (std::size_t i = 0; i < 2 * in_flight + at_rest; ++i) {
    if (i < in_flight || i >= in_flight + at_rest) t += 0.05;
    const Vector3 at(2.0 * std::sin(0.5 * t), t, std::cos(0.7 * t));
    const auto noise = [&] { return Vector3(random.normal_twist(0.005, 0.0).head<3>()); };
    keyframes.push_back({double(i), {Rotation::Identity(), at + noise()}});
    run.push_back({double(i), {Rotation::Identity(), 2.0 * (at + noise())}});
  }
}

TEST(LocalScale, OfAHoveringCameraHaveTheScaleOfItsFlight) {
  Trajectory keyframes, run;
  hover(100, 60, keyframes, run);
  std::vector<Edge> measured;
  for (std::size_t k = 105; k < 155; k += 5) measured.push_back({20, k, {}});
  for (const Edge& edge : with_local_scale(measured, keyframes, run, {})) {
    EXPECT_NEAR(edge.scale, 1.0, 0.05) << edge.to;
    EXPECT_EQ(edge.scale_information, 0.0);
  }
}

TEST(LocalScale, StateNoScaleWhereNoPathShowsOne) {
  Trajectory keyframes, run;
  hover(100, 600, keyframes, run);
  const Edge measured{20, 400, {Rotation::Identity(), Vector3(2.0, 0.0, 0.0)}};
  const auto edges = with_local_scale({measured}, keyframes, run, {});
  EXPECT_EQ(edges[0].scale, 1.0);
  EXPECT_EQ(edges[0].scale_information, kNoScaleInformation);
  EXPECT_NEAR(edges[0].from_from_to.translation.x(), 1.0, 0.05);
  EXPECT_EQ(count_without_scale(edges), 1u);
}

TEST(LocalScale, OfThreeKeyframesIsThatOfTheirLengths) {
  Trajectory keyframes, run;
  for (int i = 0; i < 3; ++i) {
    keyframes.push_back({double(i), {Rotation::Identity(), Vector3(i, 0.0, 0.0)}});
    run.push_back({double(i), {Rotation::Identity(), Vector3(2.0 * i, 0.0, 0.0)}});
  }
  const Edge measured{0, 2, {Rotation::Identity(), Vector3(4.0, 0.0, 0.0)}};
  const auto edges = with_local_scale({measured}, keyframes, run, {});
  EXPECT_NEAR(edges[0].from_from_to.translation.x(), 2.0, 1e-12);
}

}  // namespace
}  // namespace loopbench::local_scale_test
