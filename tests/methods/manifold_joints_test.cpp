#include <gtest/gtest.h>

#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/joints.hpp"
#include "methods/smoothers/manifold/spline.hpp"

namespace loopbench::methods::manifold::manifold_joints_test {
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

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_joints_test
