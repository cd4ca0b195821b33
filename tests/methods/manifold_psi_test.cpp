#include <gtest/gtest.h>

#include <numbers>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/psi.hpp"

namespace loopbench::methods::manifold::manifold_psi_test {
namespace {

TEST(Curvature, OfAHelixIsTheSameInEveryForm) {
  // Radius 2 and a rise of 3 m per radian: kappa = 2 / 13.
  const auto point = [](double t) { return Vector3(2 * std::cos(t), 2 * std::sin(t), 3 * t); };
  const Vector3 first(0, 2, 3), second(-2, 0, 0);
  EXPECT_TRUE(curvature_vector(first, second).isApprox(Vector3(-2.0 / 13.0, 0, 0), 1e-15));
  EXPECT_NEAR(discrete_curvature(point(0), point(0.01), point(0.02)), 2.0 / 13.0, 1e-5);
  EXPECT_EQ(discrete_curvature({1, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0.0);
}

TEST(Psi, FrechetMeanOfTwoDirectionsDividesTheirAngle) {
  // 90 degrees apart, weights 2 to 1: a third of the angle from the heavier direction.
  const std::vector<WeightedDirection> two{{Vector3::UnitX(), 2.0}, {Vector3::UnitY(), 1.0}};
  const double angle = std::numbers::pi / 6.0;
  EXPECT_TRUE(frechet_mean(two).isApprox(Vector3(std::cos(angle), std::sin(angle), 0), 1e-9));
  EXPECT_NEAR(dispersion(Vector3::UnitX(), two), std::numbers::pi * std::numbers::pi / 4.0, 1e-12);
  EXPECT_EQ(frechet_mean({}), Vector3::Zero());
}

TEST(Psi, ChordWeightsDecayWithTimeAndZeroChordsAreOmitted) {
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 3, 0}}));
  const auto chords = chords_around(nodes, 2, 2);
  ASSERT_EQ(chords.size(), 3u);
  EXPECT_EQ(chords[0].direction, Vector3::UnitX());
  EXPECT_NEAR(chords[0].weight, std::exp(-1.5), 1e-15);
  EXPECT_NEAR(chords[1].weight, std::exp(-0.5), 1e-15);
}

TEST(Psi, AtARightAngleTheDiscreteOneIsTheCentralChord) {
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
  const NodeSpline spline(nodes);
  const Vector3 expected = Vector3(1, 1, 0).normalized();
  EXPECT_EQ(candidates(nodes, spline, 1, 1).size(), 5u);
  EXPECT_TRUE(optimal_tangent(nodes, spline, 1, 1, PsiMean::discrete).isApprox(expected, 1e-12));
  EXPECT_TRUE(optimal_tangent(nodes, spline, 1, 1, PsiMean::frechet).isApprox(expected, 1e-12));
}

TEST(Psi, IsUndefinedAtRest) {
  const Nodes nodes(through(std::vector<Vector3>(4, Vector3(1, 2, 3))));
  EXPECT_EQ(optimal_tangent(nodes, NodeSpline(nodes), 1, 2, PsiMean::discrete), Vector3::Zero());
}

TEST(Psi, ClampedSplineHasTheGivenVelocityOnBothSides) {
  const Nodes nodes(wandering(12, 2));
  const std::vector<Clamp> at{{0, {0.1, 0.2, 0.3}}, {5, {-0.3, 0.1, 0.0}}, {11, {0.2, 0.0, 0.1}}};
  const NodeSpline spline(nodes, at);
  const auto velocity = [&](std::size_t edge, std::size_t node) {
    return spline.at(edge, time_jet(nodes.stamps[node])).point.first;
  };
  EXPECT_NEAR((velocity(0, 0) - at[0].velocity).norm(), 0.0, 1e-12);
  EXPECT_NEAR((velocity(4, 5) - at[1].velocity).norm(), 0.0, 1e-12);
  EXPECT_NEAR((velocity(5, 5) - at[1].velocity).norm(), 0.0, 1e-12);
  EXPECT_NEAR((velocity(10, 11) - at[2].velocity).norm(), 0.0, 1e-12);
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_NEAR((spline.at(i, nodes.stamps[i]).point - nodes.points[i]).norm(), 0.0, 1e-12);
    if (i > 0 && i != 5) {
      const Vector3 before = spline.at(i - 1, time_jet(nodes.stamps[i])).point.second;
      EXPECT_NEAR(
          (spline.at(i, time_jet(nodes.stamps[i])).point.second - before).norm(), 0.0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_psi_test
