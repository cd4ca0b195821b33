/// Relations, Euler angles, projections and error forms, computed by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "metrics/errors/ape.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/numerics/euler.hpp"
#include "metrics/trajectory/projection.hpp"
#include "support.hpp"

namespace loopbench::test::pose_error_test {
namespace {

constexpr double kDegree = M_PI / 180.0;

Rotation from_rpy(double roll, double pitch, double yaw) {
  return exp_so3(Vector3(0, 0, yaw)) * exp_so3(Vector3(0, pitch, 0)) * exp_so3(Vector3(roll, 0, 0));
}

TEST(Euler, TakesApartWhatWasPutTogether) {
  const Euler got = euler(from_rpy(0.3, -0.4, 2.5));
  EXPECT_NEAR(got.roll, 0.3, 1e-15);
  EXPECT_NEAR(got.pitch, -0.4, 1e-15);
  EXPECT_NEAR(got.yaw, 2.5, 1e-15);
}

TEST(Projection, KeepsTheAngleAcrossThePlane) {
  const Trajectory poses{{0.0, {from_rpy(0.1, 0.2, 0.3), Vector3(1, 2, 3)}}};
  const auto flat = [&](ProjectionPlane plane) {
    Trajectory out = poses;
    project(out, plane);
    return out[0].world_from_body;
  };
  EXPECT_TRUE(
      is_close(flat(ProjectionPlane::xy), {from_rpy(0, 0, 0.3), Vector3(1, 2, 0)}, 0.0, 1e-14));
  EXPECT_TRUE(
      is_close(flat(ProjectionPlane::xz), {from_rpy(0, 0.2, 0), Vector3(1, 0, 3)}, 0.0, 1e-14));
  EXPECT_TRUE(
      is_close(flat(ProjectionPlane::yz), {from_rpy(0.1, 0, 0), Vector3(0, 2, 3)}, 0.0, 1e-14));
  EXPECT_TRUE(is_close(flat(ProjectionPlane::none), poses[0].world_from_body, 0.0, 0.0));
}

/// The reference at the origin, then 4 m ahead; the estimate with the same start, then 5 m ahead
/// and rotated by 60 degrees about z.
Evaluation two_poses(ErrorForm form = ErrorForm::evo) {
  const Trajectory reference{{0.0, {}}, {1.0, {Rotation::Identity(), Vector3(4, 0, 0)}}};
  const Trajectory estimate{{0.0, {}}, {1.0, {from_rpy(0, 0, 60 * kDegree), Vector3(5, 0, 0)}}};
  return evaluate(reference, estimate, {.align = Align::none, .min_pairs = 1, .form = form});
}

TEST(Ape, RelationsByHand) {
  const auto max = [](Relation relation) {
    return ape(two_poses(), {relation}).at(0).statistics.max;
  };
  // |R - I| of an angle a is 2 sqrt(2) sin(a / 2).
  EXPECT_NEAR(max(Relation::translation_part), 1.0, 1e-15);
  EXPECT_NEAR(max(Relation::point_distance), 1.0, 1e-15);
  EXPECT_NEAR(max(Relation::rotation_part), std::sqrt(2.0), 5e-15);
  EXPECT_NEAR(max(Relation::full_transformation), std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(max(Relation::rotation_angle_deg), 60.0, 1e-13);
  EXPECT_NEAR(max(Relation::rotation_angle_rad), M_PI / 3.0, 1e-15);
  EXPECT_EQ(ape(two_poses(), {Relation::full_transformation}).at(0).unit, "1");
  EXPECT_EQ(ape(two_poses(), {Relation::usual}).size(), 2u);
  EXPECT_THROW(ape(two_poses(), {Relation::point_distance_error_ratio}), OptionError);
}

TEST(Ape, RollPitchYawAreOfTheTurnInTheWorld) {
  const std::vector<Score> got = ape(two_poses(), {Relation::rpy});
  EXPECT_NEAR(find(got, "rotation", "yaw").max, 60.0, 1e-13);
  EXPECT_NEAR(find(got, "rotation", "roll").max, 0.0, 1e-13);
  const std::vector<Score> axes = axis_error(two_poses(), {.rotation = true});
  EXPECT_EQ(axes.size(), 6u);
  EXPECT_NEAR(find(axes, "rotation", "yaw").max, 60.0, 1e-13);
}

TEST(Ape, TellsTheErrorOfEachPose) {
  const std::vector<PoseError> got = pose_errors(two_poses());
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[1].stamp, 1.0);
  EXPECT_TRUE(got[1].metres.isApprox(Vector3(1, 0, 0)));
  EXPECT_TRUE(got[1].radians.isApprox(Vector3(0, 0, M_PI / 3.0)));
}

TEST(Rpe, FormsGiveOtherTranslationsAndTheSameAngle) {
  const auto one = [](ErrorForm form, Relation relation) {
    return rpe(two_poses(form), {.relation = relation}).at(0).statistics.max;
  };
  for (const auto& [name, form] : choices(ErrorForm{})) {
    EXPECT_NEAR(one(form, Relation::rotation_angle_deg), 60.0, 1e-12) << name;
  }
  EXPECT_NEAR(one(ErrorForm::evo, Relation::translation_part), 1.0, 1e-15);
  EXPECT_NEAR(one(ErrorForm::kitti, Relation::translation_part), 1.0, 1e-15);
  // tum: P_i^-1 P_j (Q_i^-1 Q_j)^-1 = (60 deg, 5 x) (-4 x): 5 - 4 (cos 60, sin 60) = (3, -2 sqrt
  // 3).
  EXPECT_NEAR(one(ErrorForm::tum, Relation::translation_part), std::sqrt(21.0), 1e-14);
  // left: P_j^-1 is (-60 deg, -5 (cos 60, -sin 60)); times Q_j is (-60 deg, 4 - 5 cos.. rotated).
  EXPECT_NEAR(one(ErrorForm::left, Relation::translation_part), 1.0, 1e-14);
}

TEST(Rpe, PointDistancesCompareLengthsOfMotions) {
  const auto one = [](Relation relation) {
    return rpe(two_poses(), {.relation = relation}).at(0).statistics;
  };
  EXPECT_NEAR(one(Relation::point_distance).max, 1.0, 1e-15);
  EXPECT_NEAR(one(Relation::point_distance_error_ratio).max, 25.0, 1e-13);
  EXPECT_EQ(rpe(two_poses(), {.relation = Relation::rpy}).size(), 3u);
  EXPECT_NEAR(
      find(rpe(two_poses(), {.relation = Relation::rpy}), "rotation", "yaw").max, 60.0, 1e-12);
}

TEST(Rpe, TumPairsAreForProtocolsThatAskForThem) {
  EXPECT_EQ(why<OptionError>([] { rpe(two_poses(), {.pairs = RpePairs::tum}); }),
            "pairs = tum: needs a protocol with pairs = tum");
}

}  // namespace
}  // namespace loopbench::test::pose_error_test
