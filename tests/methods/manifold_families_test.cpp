#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/fields.hpp"
#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "methods/smoothers/manifold/families/graph.hpp"
#include "methods/smoothers/manifold/fit_axes.hpp"
#include "methods/smoothers/manifold/pieces.hpp"
#include "methods/smoothers/manifold/spatial.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::methods::manifold::manifold_families_test {

namespace {

TEST(Polynomial, ParabolaPassesThroughThreePoints) {
  const std::vector<Vector2> points{{0.0, 1.0}, {1.0, 0.0}, {3.0, 4.0}};  // y = (x - 1)^2
  const Polynomial f = fit_polynomial(points, 2);
  for (const double x : {-1.0, 0.0, 0.4, 2.0, 3.0}) EXPECT_NEAR(f(x), (x - 1) * (x - 1), 1e-12);
}

TEST(Polynomial, CubicPassesThroughFourPoints) {
  const auto truth = [](double x) { return 2.0 - x + 0.5 * x * x - 0.25 * x * x * x; };
  std::vector<Vector2> points;
  for (const double x : {1000.0, 1000.7, 1001.1, 1003.0}) points.push_back({x, truth(x - 1001.0)});
  const Polynomial f = fit_polynomial(points, 3);
  for (const double x : {1000.3, 1002.0, 1003.5}) EXPECT_NEAR(f(x), truth(x - 1001.0), 1e-9);
}

TEST(Polynomial, LeastSquaresSplitsTheError) {
  // The best line through (-1, 0) (0, 3) (1, 0) is y = 1.
  const Polynomial f = fit_polynomial(std::vector<Vector2>{{-1, 0}, {0, 3}, {1, 0}}, 1);
  EXPECT_NEAR(f(-1.0), 1.0, 1e-12);
  EXPECT_NEAR(f(1.0), 1.0, 1e-12);
}

TEST(Polynomial, FewPointsReduceTheDegree) {
  const Polynomial f = fit_polynomial(std::vector<Vector2>{{0, 1}, {2, 5}}, 3);
  EXPECT_NEAR(f(1.0), 3.0, 1e-12);
}

double saddle(const Vector2& p) {
  return 0.3 * p.x() * p.x() - 0.2 * p.y() * p.y() + 0.5 * p.x() * p.y() + p.x() - p.y() + 2.0;
}

std::vector<double> heights(const std::vector<Vector2>& points) {
  std::vector<double> out;
  for (const Vector2& point : points) out.push_back(saddle(point));
  return out;
}

TEST(Quadric, RecoversASaddleFromSixPointsInGeneralPosition) {
  const std::vector<Vector2> points{{0, 0}, {1, 0.2}, {1.8, 1}, {1.5, 2}, {0.4, 1.7}, {1, 1}};
  const auto q = fit_quadric(points, heights(points));
  ASSERT_TRUE(q);
  EXPECT_EQ(q->rank, 6);
  for (const Vector2& p : {Vector2(0.5, 0.5), Vector2(2.0, -1.0)})
    EXPECT_NEAR((*q)(p), saddle(p), 1e-9);
}

TEST(Quadric, SixPointsOnACircleLoseOneDirection) {
  std::vector<Vector2> points;
  for (int i = 0; i < 6; ++i) points.push_back({std::cos(0.5 * i), std::sin(0.5 * i)});
  const auto q = fit_quadric(points, heights(points));
  ASSERT_TRUE(q);
  EXPECT_EQ(q->rank, 5);
  // x^2 + y^2 = 1 on the circle, so another member of the family has the same heights there.
  for (const Vector2& p : points) EXPECT_NEAR((*q)(p), saddle(p), 1e-9);
  EXPECT_LT(q->coefficients.norm(), 10.0);
}

TEST(Quadric, NoiseAcrossAStraightPathIsNotAmplified) {
  // Heights of +-1 cm, lateral noise of 0.1 mm: the full solution reaches metres.
  const std::vector<Vector2> points{
      {0, 1e-4}, {1, -1e-4}, {2, 5e-5}, {3, 1e-4}, {4, 0}, {5, -1e-4}};
  const std::vector<double> z{0.01, -0.01, 0.01, -0.01, 0.01, -0.01};
  const auto q = fit_quadric(points, z);
  ASSERT_TRUE(q);
  EXPECT_LT(q->rank, 6);
  for (double x = 0.0; x <= 5.0; x += 0.1) EXPECT_LT(std::abs((*q)(Vector2(x, 0.0))), 0.02);
}

TEST(Arc, InterpolatesItsPointsAndRejectsCoincidentOnes) {
  const std::array<Vector3, 3> points{Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 2, 0)};
  const auto arc = fit_arc(points, std::array{0.0, 1.0, 3.0});
  ASSERT_TRUE(arc);
  EXPECT_TRUE((*arc)(0.0).isApprox(points[0], 1e-12));
  EXPECT_TRUE((*arc)(1.0).isApprox(points[1], 1e-12));
  EXPECT_TRUE((*arc)(3.0).isApprox(points[2], 1e-12));
  EXPECT_FALSE(fit_arc(points, std::array{0.0, 0.0, 3.0}));
}

TEST(Frame, ChordFrameIsLevel) {
  const Nodes nodes(through({{1, 1, 0}, {2, 1, 5}, {4, 1, 1}}));
  const auto frame = chord_frame(nodes, {0, 2}, Vector3::UnitZ());
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->x.isApprox(Vector3::UnitX(), 1e-12));
  EXPECT_TRUE(frame->y.isApprox(Vector3::UnitY(), 1e-12));
  EXPECT_TRUE(frame->local(nodes.points[2]).isApprox(Vector2(3, 0), 1e-12));
}

TEST(Frame, VerticalClosedAndRestingWindowsHaveNoChord) {
  const Vector3 up = Vector3::UnitZ();
  EXPECT_FALSE(chord_frame(Nodes(through({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}})), {0, 2}, up));
  EXPECT_FALSE(chord_frame(Nodes(through({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}})), {0, 2}, up));
  EXPECT_FALSE(chord_frame(Nodes(through({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})), {0, 2}, up));
}

TEST(Guard, RejectsAHairpinAStopAndARightAngle) {
  EXPECT_TRUE(is_graph(std::vector<Vector2>{{0, 0}, {1, 0.3}, {2, 0}}));
  EXPECT_FALSE(is_graph(std::vector<Vector2>{{0, 0}, {2, 0.3}, {1, 0.6}}));
  EXPECT_FALSE(is_graph(std::vector<Vector2>{{0, 0}, {1, 0}, {1.05, 0}, {2, 0}}));
  EXPECT_FALSE(is_graph(std::vector<Vector2>{{0, 0}, {1, 1.1}, {2, 0}}));
}

TEST(UpDirection, IsTheNormalOfATiltedPlane) {
  const Rotation tilt = exp_so3({0.4, -0.7, 0.1});
  Trajectory poses = through({{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}});
  for (StampedPose& pose : poses)
    pose.world_from_body = Pose{tilt, {5e5, 5e6, 0}} * pose.world_from_body;
  // Counter-clockwise motion seen against the axis.
  EXPECT_TRUE(up_axis(poses, UpDirection::pca).isApprox(tilt * Vector3::UnitZ(), 1e-9));
  EXPECT_EQ(up_axis(poses, UpDirection::world_z), Vector3::UnitZ());
}

TEST(UpDirection, OfAStraightLineIsPerpendicularAndRotatesWithTheBody) {
  Trajectory poses = through({{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {7, 14, 21}});
  const Rotation rotation = exp_so3({1.0, 2.0, -0.5});
  const Vector3 original = up_axis(poses, UpDirection::pca);
  for (StampedPose& pose : poses)
    pose.world_from_body = Pose{rotation, {9, 9, 9}} * pose.world_from_body;
  EXPECT_NEAR(original.dot(Vector3(1, 2, 3)), 0.0, 1e-9);
  EXPECT_NEAR(
      original.cross(rotation.conjugate() * up_axis(poses, UpDirection::pca)).norm(), 0.0, 1e-9);
}

/// Cameras (x right, y down, z forwards) on a walk over uneven ground, in a world with z up, with
/// yaw and pitch but without roll.
Trajectory level_walk() {
  Trajectory out;
  for (int k = 0; k < 60; ++k) {
    const double t = 0.2 * k;
    const double yaw = 2.0 * std::sin(0.7 * t), pitch = -0.4 + 0.3 * std::cos(1.3 * t);
    const Vector3 forwards(
        std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
    const Vector3 right = forwards.cross(Vector3::UnitZ()).normalized();
    Matrix3 axes;
    axes << right, forwards.cross(right), forwards;
    out.push_back({t, {Rotation(axes), {3.0 * std::sin(0.5 * t), std::cos(0.4 * t), 0.1 * t}}});
  }
  return out;
}

const Pose kMoved{Rotation(Eigen::AngleAxisd(1.1, Vector3(0.3, -0.5, 0.8).normalized())),
                  {4.0, -2.0, 7.0}};

double largest_difference(const Dm::Options& options) {
  Report report;
  const Problem problem{.keyframes = level_walk()};
  const auto here = Dm(options).smooth(problem, report);
  const auto there = Dm(options).smooth(test::moved_by(kMoved, problem), report);
  double out = 0.0;
  for (double t = 0.0; t <= 11.8; t += 0.05) {
    out = std::max(out, (kMoved * here->at(t).translation - there->at(t).translation).norm());
  }
  return out;
}

TEST(FitAxes, GravityIsTheDirectionThatLevelCamerasShare) {
  const Trajectory walk = level_walk();
  const Rotation axes = manifold::level_axes(walk);
  EXPECT_NEAR((axes.conjugate() * Vector3::UnitZ() - Vector3::UnitZ()).norm(), 0.0, 1e-12);
  const Rotation seen = manifold::level_axes(test::moved_by(kMoved, {.keyframes = walk}).keyframes);
  EXPECT_NEAR((seen * kMoved.rotation).angularDistance(axes), 0.0, 1e-9);
  EXPECT_TRUE(manifold::level_axes({}).isApprox(Rotation::Identity()));
}

TEST(FitAxes, OfGravityMakeTheResultIndependentOfTheFile) {
  Dm::Options options{.planar = 4,
                      .up = manifold::UpDirection::world_z,
                      .height_guard = false,
                      .frame = manifold::Axes::world,
                      .guard = false,
                      .families = "poly2"};
  EXPECT_GT(largest_difference(options), 1e-3);
  options.fit_axes = FitAxes::gravity;
  EXPECT_NEAR(largest_difference(options), 0.0, 1e-8);
  options.plane = Plane::xoz;
  EXPECT_NEAR(largest_difference(options), 0.0, 1e-8);
}

TEST(FitAxes, OfChordsHaveNoOtherPlane) { EXPECT_THROW(Dm({.plane = Plane::yoz}), OptionError); }

TEST(FitAxes, PlanesNameTheCoordinateThatIsReplaced) {
  struct Case {
    Plane plane;
    int argument, value;  ///< axes of a parabola that the fit reproduces
  };
  for (const auto& [plane, argument, value] :
       {Case{Plane::xoy, 0, 1}, Case{Plane::yoz, 1, 2}, Case{Plane::xoz, 0, 2}}) {
    Problem problem;
    for (int k = 0; k < 9; ++k) {
      const double u = 0.3 * k + 0.1 * std::sin(2.0 * k);
      Vector3 point = Vector3::Constant(0.2 * std::sin(3.0 * k));
      point[argument] = u;
      point[value] = 0.5 * u * u;
      problem.keyframes.push_back({1.0 * k, {Rotation::Identity(), point}});
    }
    const Dm::Options options{.planar = 3,
                              .frame = manifold::Axes::world,
                              .plane = plane,
                              .guard = false,
                              .joint = {.kind = manifold::JointKind::none}};
    Report report;
    const auto curve = Dm(options).smooth(problem, report);
    for (double t = 0.0; t <= 8.0; t += 0.1) {
      const Vector3 p = curve->at(t).translation;
      EXPECT_NEAR(p[value], 0.5 * p[argument] * p[argument], 1e-9) << to_text(plane);
    }
  }
}

TEST(FitAxes, QuinticBridgesPassThroughInterpolatedNodesWithoutAnyGuard) {
  const Problem problem{.keyframes = level_walk()};
  for (const auto& [planar, spatial] : {std::pair{3, 0}, std::pair{4, 0}, std::pair{0, 6}}) {
    Dm::Options options{
        .planar = planar,
        .spatial = spatial,
        .height_guard = false,
        .frame = manifold::Axes::world,
        .guard = false,
        .quadric_cut = 1e-12,
        .joint = {.kind = manifold::JointKind::quintic_bridge},
        .psi = planar > 0 ? manifold::PsiUse::boundary_tangent : manifold::PsiUse::none};
    Report report;
    const auto curve = Dm(options).smooth(problem, report);
    for (const auto& [stamp, pose] : problem.keyframes) {
      EXPECT_NEAR((curve->at(stamp).translation - pose.translation).norm(), 0.0, 1e-6) << planar;
    }
    EXPECT_LT(test::count(report, "jump_acceleration"), 1e-3);
  }
}

}  // namespace
}  // namespace loopbench::methods::manifold::manifold_families_test
