#include <gtest/gtest.h>

#include <numbers>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/families/jet.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/psi.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold::manifold_spline_test {
namespace {

TEST(NodeSpline, AgreesWithTheNaturalSplineByHand) {
  // y = 0, 1, 0 at 0, 1, 2 s: the second derivative in the middle is -3.
  const NodeSpline spline(Nodes(through({{0, 0, 0}, {0, 1, 0}, {0, 0, 0}})));
  EXPECT_NEAR(spline.at(0, 0.5).point.y(), 0.6875, 1e-15);
  EXPECT_NEAR(spline.at(1, 1.5).point.y(), 0.6875, 1e-15);
}

TEST(NodeSpline, InterpolatesEveryNodeAndTheArcLength) {
  const Nodes nodes(wandering(30, 1));
  const NodeSpline spline(nodes);
  double path_length = 0.0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    EXPECT_TRUE(spline.at(i, nodes.stamps[i]).point.isApprox(nodes.points[i], 1e-12));
    EXPECT_NEAR(spline.at(i, nodes.stamps[i]).distance, path_length, 1e-12);
    path_length += nodes.step(i).norm();
    EXPECT_TRUE(spline.at(i, nodes.stamps[i + 1]).point.isApprox(nodes.points[i + 1], 1e-12));
  }
  EXPECT_NEAR(spline.distance(29), path_length, 1e-12);
}

TEST(Joint, WeightIsFlatToSecondOrderAtBothEnds) {
  const Joint joint{2.0, 4.0};
  EXPECT_EQ(joint.weight(1.0), 0.0);
  EXPECT_EQ(joint.weight(2.0), 0.0);
  EXPECT_EQ(joint.weight(3.0), 0.5);
  EXPECT_NEAR(joint.weight(2.5), 0.103515625, 1e-15);
  EXPECT_EQ(joint.weight(4.0), 1.0);
  EXPECT_EQ(joint.weight(5.0), 1.0);
  const double h = 1e-3;  // s = h / 2: the leading term is 10 s^3
  EXPECT_NEAR(joint.weight(2.0 + h), 10.0 * std::pow(h / 2, 3), 1e-11);
  EXPECT_NEAR(1.0 - joint.weight(4.0 - h), 10.0 * std::pow(h / 2, 3), 1e-11);
}

TEST(Joint, ExtendsOneNodeForEqualSpacing) {
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}));
  const Joint joint = joint_between(nodes, {{0, 2}, {0, 2}}, {{2, 4}, {2, 4}});
  EXPECT_EQ(joint.begin, 1.0);
  EXPECT_EQ(joint.end, 3.0);
}

TEST(Joint, ExtendsAtMostByThePiecesLastStep) {
  // Last step 1 m, next step 4 m in one second: the earlier piece extends by a quarter of a second.
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {6, 0, 0}, {9, 0, 0}}));
  const Joint joint = joint_between(nodes, {{0, 2}, {0, 2}}, {{2, 4}, {2, 4}});
  EXPECT_EQ(joint.begin, 1.0);
  EXPECT_EQ(joint.end, 2.25);
  // It extends over the whole step when node 3 is in its window.
  EXPECT_EQ(joint_between(nodes, {{1, 3}, {1, 2}}, {{2, 4}, {2, 4}}).end, 3.0);
}

TEST(Joint, OfSlidingWindowsCoversTheEdgesTheyRepresent) {
  const Nodes nodes(wandering(6, 1));
  const Window line{{1, 2}, {1, 2}}, three{{1, 3}, {2, 3}}, next{{2, 4}, {3, 4}};
  const Joint around_nodes = sliding_joint(nodes, three, next, 3);
  EXPECT_EQ(around_nodes.begin, nodes.stamps[2]);
  EXPECT_EQ(around_nodes.end, nodes.stamps[3]);
  // A straight line is blended around the node; over the whole earlier edge it would be
  // extrapolated.
  const Joint after_line = sliding_joint(nodes, line, three, 3);
  EXPECT_NEAR(after_line.begin, 0.5 * (nodes.stamps[1] + nodes.stamps[2]), 1e-12);
  EXPECT_NEAR(after_line.end, 0.5 * (nodes.stamps[2] + nodes.stamps[3]), 1e-12);
}

TEST(PiecewiseCurve, BlendsNeighboursAtTheirJointOnly) {
  const Nodes nodes(through(std::vector<Vector3>(9, Vector3::Zero())));
  const std::vector<Window> windows{{{0, 4}, {0, 4}}, {{4, 8}, {4, 8}}};
  const auto constant_piece = [](double piece, std::size_t, const Jet<double>&) {
    return Jet<double>{piece, 0.0, 0.0};
  };
  const auto curve =
      join_pieces<double>(nodes, windows, std::vector{10.0, 20.0}, {}, constant_piece);
  const auto identity = [](double piece) { return piece; };
  EXPECT_EQ(curve.at(0, 0.5, identity), 10.0);
  EXPECT_EQ(curve.at(4, 4.0, identity), 15.0);
  EXPECT_NEAR(curve.at(4, 4.5, identity), 20.0 - 1.03515625, 1e-12);
  EXPECT_EQ(curve.at(7, 8.0, identity), 20.0);
}

using Value = BSpline::Value;

const std::vector<double> kSites{0.0, 0.4, 1.0, 1.3, 2.1, 2.5, 3.4, 4.0};

std::vector<Value> values_of(const std::function<Value(double)>& f) {
  std::vector<Value> out;
  for (const double u : kSites) out.push_back(f(u));
  return out;
}
Value smooth_function(double u) { return {std::sin(u), std::cos(2 * u), u * u, 1.0 / (1.0 + u)}; }

// Corrected equation (12), implemented literally and slowly.
double N(const std::vector<double>& m, std::size_t t, std::size_t k, double u) {
  if (k == 1) return m[t] <= u && u < m[t + 1] ? 1.0 : 0.0;
  const auto share = [](double above, double below) { return below == 0.0 ? 0.0 : above / below; };
  return share(u - m[t], m[t + k - 1] - m[t]) * N(m, t, k - 1, u) +
         share(m[t + k] - u, m[t + k] - m[t + 1]) * N(m, t + 1, k - 1, u);
}

class EveryOrder : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(BSpline, EveryOrder, testing::Values(2u, 3u, 4u, 5u, 6u));

TEST_P(EveryOrder, BasisIsTheRecursion) {
  const std::size_t k = GetParam();
  const SplineBasis basis = SplineBasis::for_sites(k, kSites);
  std::vector<double> knots(k - 1, basis.breaks().front());
  knots.insert(knots.end(), basis.breaks().begin(), basis.breaks().end());
  knots.insert(knots.end(), k - 1, basis.breaks().back());
  for (double u = 0.0; u < 4.0; u += 0.037) {
    const std::size_t piece = basis.piece_at(u);
    const auto values = basis.values(piece, u);
    for (std::size_t j = 0; j < k; ++j) {
      EXPECT_NEAR(values[j], N(knots, piece + j, k, u), 1e-12) << u;
    }
  }
}

TEST_P(EveryOrder, JetsAgreeWithDifferences) {
  if (GetParam() < 4) return;  // the second derivative is not continuous
  const BSpline spline = BSpline::through(kSites, values_of(smooth_function), GetParam());
  const double h = 1e-4, u = 1.55;
  const Jet<Value> jet = spline.at(time_jet(u));
  EXPECT_NEAR((jet.first - (spline.at(u + h) - spline.at(u - h)) / (2 * h)).norm(), 0.0, 1e-5);
  EXPECT_LT(
      (jet.second - (spline.at(u + h) - 2 * spline.at(u) + spline.at(u - h)) / (h * h)).norm(),
      1e-4);
}

TEST(NodeSpline, PolylineIsStraightBetweenNodes) {
  const Nodes nodes(through({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}));
  EXPECT_TRUE(NodeSpline::polyline(nodes).at(1, 1.25).point.isApprox(Vector3(1, 0.5, 0), 1e-15));
}

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
}  // namespace loopbench::methods::manifold::manifold_spline_test
