#include "methods/smoothers/manifold/fit_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/fields.hpp"
#include "manifold_paths.hpp"
#include "methods/smoothers/manifold/dm.hpp"
#include "tests/support/corrected.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::fit_axes_test {

using namespace methods;
using manifold::FitAxes;
using manifold::Plane;

namespace {

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

TEST(FitAxes, OfTheReferenceAreNotAvailableToAMethod) {
  EXPECT_THROW(Dm({.fit_axes = FitAxes::reference}), OptionError);
  EXPECT_THROW(Dm({.plane = Plane::yoz}), OptionError);  // chord axes have no such plane
}

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
}  // namespace loopbench::fit_axes_test
