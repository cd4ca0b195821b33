#include <gtest/gtest.h>

#include <numbers>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/frenet.hpp"
#include "methods/smoothers/manifold/psi.hpp"

namespace loopbench::methods::manifold::manifold_frenet_test {
namespace {

// Right-handed helix of radius 2 with a rise of 3 m per radian: kappa = 2 / 13, tau = 3 / 13.
struct Helix {
  double t;
  Vector3 at() const { return {2 * std::cos(t), 2 * std::sin(t), 3 * t}; }
  Vector3 first() const { return {-2 * std::sin(t), 2 * std::cos(t), 3}; }
  Vector3 second() const { return {-2 * std::cos(t), -2 * std::sin(t), 0}; }
  Vector3 third() const { return {2 * std::sin(t), -2 * std::cos(t), 0}; }
};

TEST(Frenet, HelixHasTheAnalyticCurvatureTorsionAndFrame) {
  const Helix helix{0.7};
  EXPECT_NEAR(curvature(helix.first(), helix.second()), 2.0 / 13.0, 1e-15);
  EXPECT_NEAR(torsion(helix.first(), helix.second(), helix.third()).value(), 3.0 / 13.0, 1e-15);
  EXPECT_NEAR(curvature_vector(helix.first(), helix.second()).norm(), 2.0 / 13.0, 1e-15);
  const Triad triad = frenet(helix.first(), helix.second()).value();
  EXPECT_TRUE(triad.N.isApprox(Vector3(-std::cos(0.7), -std::sin(0.7), 0.0), 1e-12));
  EXPECT_TRUE(triad.T.cross(triad.N).isApprox(triad.B, 1e-12));
}

TEST(Frenet, CircleLiesInItsPlane) {
  const Vector3 first(0, 5, 0), second(-5, 0, 0), third(0, -5, 0);  // radius 5, at (5, 0)
  EXPECT_NEAR(curvature(first, second), 0.2, 1e-15);
  EXPECT_NEAR(torsion(first, second, third).value(), 0.0, 1e-15);
  EXPECT_TRUE(frenet(first, second)->B.isApprox(Vector3::UnitZ(), 1e-15));
}

TEST(Frenet, IsUndefinedOnStraightLinesAndAtRest) {
  EXPECT_FALSE(frenet({1, 2, 3}, {2, 4, 6}));
  EXPECT_FALSE(frenet({1, 2, 3}, Vector3::Zero()));
  EXPECT_FALSE(frenet(Vector3::Zero(), {1, 0, 0}));
  EXPECT_FALSE(torsion({1, 2, 3}, {2, 4, 6}, {1, 0, 0}));
  EXPECT_EQ(curvature(Vector3::Zero(), {1, 0, 0}), 0.0);
}

TEST(Frenet, DiscreteValuesApproachTheAnalyticOnes) {
  const double h = 1e-2;
  const auto p = [&](int k) { return Helix{k * h}.at(); };
  EXPECT_NEAR(discrete_curvature(p(0), p(1), p(2)), 2.0 / 13.0, 1e-5);
  EXPECT_NEAR(discrete_torsion(p(0), p(1), p(2), p(3)).value(), 3.0 / 13.0, 1e-4);
  EXPECT_NEAR(discrete_curvature({1, 0, 0}, {0, 1, 0}, {-1, 0, 0}), 1.0, 1e-15);
  EXPECT_EQ(discrete_curvature({1, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0.0);
  EXPECT_FALSE(discrete_torsion({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}));
}

TEST(RotationMinimising, IsConstantOnAStraightLine) {
  const std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  const std::vector<Vector3> tangents(5, Vector3::UnitX());
  const Triad start{Vector3::UnitX(), Vector3(0, 0.6, 0.8), Vector3(0, -0.8, 0.6)};
  for (const Triad& triad : rotation_minimising(points, tangents, start)) {
    EXPECT_TRUE(triad.N.isApprox(start.N, 1e-15));
    EXPECT_TRUE(triad.B.isApprox(start.B, 1e-15));
  }
}

TEST(RotationMinimising, KeepsTheNormalOfAPlaneAndRotatesWithTheTorsion) {
  std::vector<Vector3> points, tangents;
  for (int i = 0; i <= 100; ++i) {
    const double a = 0.05 * i;
    points.push_back({std::cos(a), std::sin(a), 0});
    tangents.push_back({-std::sin(a), std::cos(a), 0});
  }
  const Triad flat{tangents[0], Vector3(-1, 0, 0), Vector3::UnitZ()};
  EXPECT_TRUE(
      rotation_minimising(points, tangents, flat).back().B.isApprox(Vector3::UnitZ(), 1e-12));

  // On the helix the Frenet frame rotates relative to it by the integral of the torsion.
  std::vector<Vector3> up, along_up;
  for (int i = 0; i <= 400; ++i) {
    up.push_back(Helix{0.005 * i}.at());
    along_up.push_back(Helix{0.005 * i}.first().normalized());
  }
  const Triad start = frenet(Helix{0}.first(), Helix{0}.second()).value();
  const Triad propagated = rotation_minimising(up, along_up, start).back();
  const Triad frenet_frame = frenet(Helix{2}.first(), Helix{2}.second()).value();
  const double expected = 3.0 / 13.0 * 2.0 * std::sqrt(13.0);
  EXPECT_NEAR(angle_between_directions(propagated.N, frenet_frame.N), expected, 1e-5);
}

TEST(AnyTriad, IsRightHandedAndUnit) {
  for (const Vector3& t : {Vector3(1, 0, 0), Vector3(0, 0.6, 0.8), Vector3(1, 1, 1).normalized()}) {
    const Triad triad = arbitrary_triad(t);
    EXPECT_NEAR(triad.N.dot(t), 0.0, 1e-15);
    EXPECT_TRUE(triad.T.cross(triad.N).isApprox(triad.B, 1e-15));
  }
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
  EXPECT_LT((velocity(0, 0) - at[0].velocity).norm(), 1e-12);
  EXPECT_LT((velocity(4, 5) - at[1].velocity).norm(), 1e-12);
  EXPECT_LT((velocity(5, 5) - at[1].velocity).norm(), 1e-12);
  EXPECT_LT((velocity(10, 11) - at[2].velocity).norm(), 1e-12);
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_LT((spline.at(i, nodes.stamps[i]).point - nodes.points[i]).norm(), 1e-12);
    if (i > 0 && i != 5) {
      const Vector3 before = spline.at(i - 1, time_jet(nodes.stamps[i])).point.second;
      EXPECT_LT((spline.at(i, time_jet(nodes.stamps[i])).point.second - before).norm(), 1e-10);
    }
  }
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_frenet_test
