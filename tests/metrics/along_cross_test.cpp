#include "metrics/errors/along_cross.hpp"

#include "metrics/correction/smoothness.hpp"
#include "metrics/errors/ate.hpp"
#include "support.hpp"

namespace loopbench::test::along_cross_test {
namespace {

/// Two metres along x, then two along y, at 1 m/s.
Trajectory corner() {
  Trajectory out(5);
  const std::array<Vector3, 5> positions{
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {2.0, 1.0, 0.0}, {2.0, 2.0, 0.0}}};
  for (std::size_t i = 0; i < 5; ++i) {
    out[i].stamp = static_cast<double>(i);
    out[i].world_from_body.translation = positions[i];
    out[i].world_from_body.rotation = exp_so3({0.0, 0.0, 0.3 * static_cast<double>(i)});
  }
  return out;
}

Evaluation beside(const Trajectory& reference, const Trajectory& estimate) {
  return evaluate(reference, estimate, {.align = Align::none});
}

TEST(AlongCross, ByHandOnBothArmsOfACorner) {
  Trajectory estimate = corner();
  estimate[1].world_from_body.translation += Vector3(3.0, 4.0, 12.0);  // travelling along x
  estimate[4].world_from_body.translation += Vector3(3.0, 4.0, 12.0);  // travelling along y
  const auto scores = along_cross(beside(corner(), estimate), {});
  EXPECT_DOUBLE_EQ(find(scores, "translation", "along").sse, 9.0 + 16.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "cross").sse, 16.0 + 9.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "vertical").sse, 144.0 + 144.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "off_track").sse, 160.0 + 153.0);
  const auto camera = along_cross(beside(corner(), estimate), {.up = UpAxis::x});
  EXPECT_EQ(find(camera, "translation", "cross").count, 3u);  // the first two travel along x
}

TEST(AlongCross, KeepsTheDirectionWhileStanding) {
  Trajectory reference = corner();
  for (int k = 0; k < 20; ++k) {  // jitter of a millimetre along x
    reference.push_back(reference.back());
    reference.back().stamp += 0.25;
    reference.back().world_from_body.translation.x() += k % 2 == 0 ? 1e-3 : -1e-3;
  }
  Trajectory estimate = reference;
  estimate.back().world_from_body.translation += Vector3(0.0, 5.0, 0.0);
  const auto scores = along_cross(beside(reference, estimate), {});
  EXPECT_DOUBLE_EQ(find(scores, "translation", "along").max, 5.0);
  EXPECT_DOUBLE_EQ(find(scores, "translation", "cross").max, 0.0);
}

TEST(AlongCross, AlongAndOffTrackDoNotCareHowTheWorldIsTurned) {
  std::mt19937_64 random(3);
  const Trajectory reference = test::random_walk(random, 200);
  const Trajectory estimate = test::noisy(random, reference, 0.2, 0.1);
  const Pose motion = test::random_pose(random, 10.0, 2.0);
  const auto here = along_cross(beside(reference, estimate), {});
  const auto there =
      along_cross(beside(moved_by(motion, 1.0, reference), moved_by(motion, 1.0, estimate)), {});
  for (const char* axis : {"along", "off_track"}) {
    EXPECT_NEAR(find(here, "translation", axis).rmse, find(there, "translation", axis).rmse, 1e-12);
  }
  const double complete = find(ate(beside(reference, estimate), {}), "translation", "3d").sse;
  const double off_track = find(here, "translation", "off_track").sse;
  EXPECT_NEAR(find(here, "translation", "along").sse + off_track, complete, 1e-12 * complete);
  EXPECT_NEAR(find(here, "translation", "cross").sse + find(here, "translation", "vertical").sse,
              off_track,
              1e-12 * complete);
}

TEST(AlongCross, RefusesAReferenceThatNeverMoves) {
  Trajectory still = corner();
  for (StampedPose& pose : still) pose.world_from_body.translation.setZero();
  EXPECT_EQ(why<std::runtime_error>([&] { along_cross(beside(still, still), {}); }),
            "the reference never moves faster than 0.05 m/s, so it has no direction "
            "of travel");
}

TEST(PathLength, IsTheRatioOfTheStraightSteps) {
  const Trajectory longer = moved_by({}, 1.5, corner());
  const auto scores = path_length_ratio(beside(corner(), longer));
  EXPECT_DOUBLE_EQ(find(scores, "reference", "").mean, 4.0);
  EXPECT_DOUBLE_EQ(find(scores, "estimate", "").mean, 6.0);
  EXPECT_DOUBLE_EQ(find(scores, "ratio", "").rmse, 1.5);
}

TEST(PathLength, RefusesAReferenceThatStandsStill) {
  Trajectory still = corner();
  for (StampedPose& pose : still) pose.world_from_body.translation.setZero();
  EXPECT_THROW(path_length_ratio(beside(still, corner())), std::runtime_error);
}

}  // namespace
}  // namespace loopbench::test::along_cross_test
