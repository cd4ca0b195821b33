#include "metrics/checks/diagnostics.hpp"

#include <cstdlib>
#include <filesystem>

#include "datasets/formats/formats.hpp"
#include "metrics/errors/ate.hpp"
#include "metrics/errors/axis_error.hpp"
#include "metrics/errors/rpe.hpp"
#include "metrics/trajectory/position_only.hpp"
#include "support.hpp"

namespace loopbench::test::diagnostics_test {
namespace {

/// 1 m/s along x for 5 s, 5 s at rest, then along y; 10 Hz.
Trajectory with_a_stop() {
  Trajectory out;
  for (int k = 0; k <= 150; ++k) {
    const double t = 0.1 * k;
    const Vector3 place(std::min(t, 5.0), std::max(t - 10.0, 0.0), 0.0);
    out.push_back({t, {exp_so3({0.0, 0.0, 0.05 * t}), place}});
  }
  return out;
}

Trajectory without(Trajectory poses, double from, double to) {
  std::erase_if(poses, [&](const StampedPose& p) { return p.stamp > from && p.stamp < to; });
  return poses;
}

Diagnostics of(const Trajectory& reference,
               const Trajectory& estimate,
               const Protocol& protocol = {}) {
  Evaluation e = evaluate(reference, estimate, protocol);
  e.context = {.reference = &reference, .estimate = &estimate, .protocol = protocol};
  return diagnose(e, {});
}

TEST(Diagnostics, OfAHealthyPair) {
  const Diagnostics d = of(with_a_stop(), with_a_stop());
  EXPECT_EQ(d.matched, 151u);
  EXPECT_EQ(d.possible, 151u);
  EXPECT_NEAR(d.longest_pair_interval, 0.1, 1e-12);
  EXPECT_EQ(d.repeated + d.crossing + d.tracking_gaps, 0u);
  EXPECT_NEAR(d.off_unit, 0.0, 1e-15);
  EXPECT_EQ(d.rank, 2);         // planar motion
  EXPECT_EQ(d.condition, 1.0);  // aligned in the plane
  // The window of 0.5 s on either side includes motion: at rest from 5.5 to 9.5 s.
  EXPECT_NEAR(d.at_rest, 40.0 / 151.0, 2.0 / 151.0);
  EXPECT_FALSE(d.position_only_reference || d.position_only_estimate);
}

TEST(Diagnostics, ALossIsAPauseDuringWhichTheReferenceMoved) {
  const Trajectory reference = with_a_stop();
  const Diagnostics moving = of(reference, without(reference, 1.05, 4.05));
  EXPECT_EQ(moving.tracking_gaps, 1u);
  EXPECT_NEAR(moving.tracking_gap_time, 3.1, 1e-9);
  EXPECT_NEAR(moving.longest_tracking_gap, 3.1, 1e-9);
  EXPECT_NEAR(moving.longest_pair_interval, 3.1, 1e-9);
  const Diagnostics standing = of(reference, without(reference, 6.05, 9.05));
  EXPECT_EQ(standing.tracking_gaps, 0u);
  EXPECT_NEAR(standing.longest_pair_interval, 3.1, 1e-9);
  const Trajectory holed = without(reference, 1.05, 4.05);  // gap of the reference itself
  EXPECT_EQ(of(holed, reference).tracking_gaps, 0u);
  EXPECT_EQ(of(reference, without(without(reference, 0.05, 2.55), 10.05, 14.05)).tracking_gaps, 2u);
}

TEST(Diagnostics, CountsPosesUsedAgainAndPairsThatCross) {
  const Trajectory reference = with_a_stop();
  Trajectory burst = reference;
  burst.insert(burst.begin() + 11, burst[10]);
  burst[11].stamp += 0.004;
  burst.resize(60);
  const Diagnostics evo =
      of(reference, burst, {.association = Association::evo, .align = Align::none});
  EXPECT_EQ(evo.repeated, 1u);
  Evaluation crossed = evaluate(reference, reference, {});
  std::swap(crossed.estimate[7], crossed.estimate[8]);
  EXPECT_EQ(diagnose(crossed, {}).crossing, 1u);
}

TEST(Diagnostics, ScoresAreSingleNumbers) {
  const Trajectory reference = with_a_stop();
  const Trajectory estimate = without(reference, 1.05, 4.05);
  Evaluation e = evaluate(reference, estimate, {});
  e.context.reference = &reference;
  e.context.estimate = &estimate;
  for (const Score& score : diagnostics(e, {})) {
    EXPECT_EQ(score.statistics.count, 1u);
    EXPECT_EQ(score.statistics.rmse, score.statistics.max) << score.relation;
  }
  EXPECT_NEAR(find(diagnostics(e, {}), "tracking_gap_time", "").mean, 3.1, 1e-9);
}

/// A curved path with constant orientation, as from GPS.
Trajectory positions_only(const Rotation& attitude) {
  Trajectory out = with_a_stop();
  for (StampedPose& pose : out) pose.world_from_body.rotation = attitude;
  return out;
}

TEST(PositionOnly, IsOneAttitudeOnAPathThatTurns) {
  EXPECT_TRUE(is_position_only(positions_only(Rotation::Identity())));
  EXPECT_TRUE(is_position_only(positions_only(exp_so3({0.3, -2.0, 1.0}))));
  EXPECT_FALSE(is_position_only(with_a_stop()));
  Trajectory straight = positions_only(Rotation::Identity());
  straight.resize(60);
  EXPECT_FALSE(is_position_only(straight));        // can be a real straight drive
  EXPECT_FALSE(is_position_only(Trajectory(20)));  // at rest
  Trajectory few{straight[40], straight[45], straight[50], straight[55]};
  few[1].world_from_body.translation.y() += 1.0;
  EXPECT_FALSE(is_position_only(few));
  EXPECT_FALSE(is_position_only({}));
}

TEST(PositionOnly, RotationIsRefusedAndPositionIsNot) {
  const Trajectory reference = positions_only(Rotation::Identity());
  const Evaluation e = evaluate(reference, with_a_stop(), {});
  const std::string why =
      "the reference has a constant orientation although its path is curved: it holds only "
      "positions, so rotation is not evaluated";
  EXPECT_EQ(why_no_attitude(e), why);
  const auto absolute = ate(e, {});
  EXPECT_EQ(absolute[0].why_undefined, "");
  EXPECT_EQ(absolute[0].statistics.count, 151u);
  EXPECT_EQ(absolute[1].why_undefined, why);
  EXPECT_EQ(absolute[1].statistics.count, 0u);
  for (const Score& score : rpe(e, {.frame = RpeFrame::world})) {
    const bool is_axis = score.axis != "3d";  // independent of orientations
    EXPECT_EQ(score.why_undefined, is_axis ? "" : why) << score.relation << score.axis;
  }
  for (const Score& score : rpe(e, {})) EXPECT_EQ(score.why_undefined, why);
  for (const Score& score : axis_error(e, {})) EXPECT_EQ(score.why_undefined, "");
  EXPECT_EQ(find(diagnostics(e, {}), "position_only_reference", "").mean, 1.0);
}

TEST(PositionOnly, IsWhatThePublishedTruthOfTheHagueIs) {
  const char* folder = std::getenv("LOOPBENCH_DATA");
  if (folder == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const std::filesystem::path data = std::filesystem::path(folder) / "cop_slam";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not there";
  EXPECT_TRUE(is_position_only(read_trajectory(data / "TheHague_02_gt.g2o", {})));
  EXPECT_FALSE(is_position_only(read_trajectory(data / "TheHague_02_vo.g2o", {})));
  EXPECT_FALSE(is_position_only(read_trajectory(data / "KITTI_00_gt.g2o", {})));
}

TEST(PositionOnly, AnEstimateCanBeSoToo) {
  const Evaluation e = evaluate(with_a_stop(), positions_only(exp_so3({1.0, 0.0, 0.0})), {});
  EXPECT_EQ(why_no_attitude(e).substr(0, 12), "the estimate");
  EXPECT_NE(ate(e, {})[1].why_undefined, "");
}

}  // namespace
}  // namespace loopbench::test::diagnostics_test
