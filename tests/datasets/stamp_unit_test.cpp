// Stamps as people have them: units, order, digits, frames, and rows that are no poses.
#include "datasets/formats/stamp_unit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::stamp_unit_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kPose = " 1 2 3 0 0 0.6 0.8\n";

/// Rows of TUM with these stamps and different poses.
std::string rows(const std::vector<std::string>& stamps) {
  std::string out;
  for (const std::string& stamp : stamps) {
    out += stamp + " " + std::to_string(out.size()) + " 2 3 0 0 0.6 0.8\n";
  }
  return out;
}

Trajectory read_text(const std::string& text, ReadOptions options = {}) {
  const TemporaryFolder scratch;
  return read_trajectory(scratch.file("a.txt", text), options);
}

std::string why(const std::string& text, ReadOptions options = {}) {
  return refusal([&] { read_text(text, options); });
}

double last_stamp(const std::vector<std::string>& stamps) {
  return read_text(rows(stamps)).back().stamp;
}

TEST(StampUnits, FollowFromSizeAndInterval) {
  EXPECT_EQ(last_stamp({"1604644894000", "1604644894100"}), 1604644894.1);
  EXPECT_EQ(last_stamp({"1604644894000.0", "1604644894100.5"}), 1604644894.1005);
  EXPECT_EQ(last_stamp({"1604644894000000", "1604644894100000"}), 1604644894.1);
  EXPECT_EQ(last_stamp({"1604644894000000000", "1604644894100000000"}), 1604644894.1);
  EXPECT_EQ(last_stamp({"1.604644894000000000e+18", "1.604644894100000000e+18"}), 1604644894.1);
  EXPECT_EQ(last_stamp({"12300000", "12400000"}), 12.4);    // microseconds at 10 Hz
  EXPECT_EQ(last_stamp({"12300000", "12305000"}), 12.305);  // at 200 Hz
  EXPECT_EQ(last_stamp({"12300000000", "12333333333"}), 12.333333333);
  EXPECT_EQ(last_stamp({"0", "1"}), 1.0);
  EXPECT_EQ(last_stamp({"0", "100"}), 100.0);
  EXPECT_EQ(last_stamp({"1604644894", "1604644895"}), 1604644895.0);
}

TEST(StampUnits, AreDecidedByTheOtherFileIfTwoFit) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.txt", rows({"1000000", "2000000", "3000000"}));
  ReadFindings findings;
  ReadOptions options{.findings = &findings};
  const Trajectory poses = read_trajectory(file, options);
  EXPECT_FALSE(findings.has_clear_unit);
  EXPECT_THAT(refusal([&] { require_clear_unit("a.txt", findings); }), HasSubstr("us"));
  EXPECT_EQ(better_unit(poses, findings, read_text(rows({"1.0", "3.1"}))), StampUnit::us);
  EXPECT_EQ(better_unit(poses, findings, read_text(rows({"0.001", "0.003"}))), StampUnit::ns);
  EXPECT_EQ(better_unit(poses, findings, read_text(rows({"5e8", "6e8"}))), StampUnit::automatic);
  options.stamp_unit = StampUnit::us;
  EXPECT_EQ(read_trajectory(file, options).back().stamp, 3.0);
}

TEST(StampUnits, KeysOfGraphsAreNoStamps) {
  EXPECT_THAT(why(rows({"8646911284551352320", "8646911284551352321"})), HasSubstr("key of GTSAM"));
}

TEST(StampOrder, StampsOneNanosecondApartAreDifferent) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.txt", rows({"1604644894000000000", "1604644894000000001"}));
  const TrajectoryFile read = read_trajectory_file(file, {.stamp_unit = StampUnit::ns});
  EXPECT_THAT(read.nanoseconds, ElementsAre(1604644894000000000, 1604644894000000001));
  EXPECT_LT(read.poses[0].stamp, read.poses[1].stamp);
}

TEST(StampOrder, LostDigitsAreNamed) {
  const std::string few = rows({"1600000000", "1600000000", "1600000000", "1600000001"});
  EXPECT_THAT(why(few), HasSubstr("2 of 4 rows have the stamp of the row above: stamps have too"));
  EXPECT_THAT(why(few), testing::Not(HasSubstr("keep_first")));
  EXPECT_THAT(why(rows({"0", "0", "0"})), HasSubstr("stamps are 0"));
  EXPECT_THAT(why(rows({"1", "2", "2", "3"})), HasSubstr("keep_first"));
}

TEST(StampOrder, SortTakesRowsInAnyOrder) {
  const std::string text = "2.0 1 2 3 0 0 0.6 0.8\n1.0 4 5 6 0 0 0.6 0.8\n3.0 7 8 9 0 0 0.6 0.8\n";
  EXPECT_THAT(why(text), HasSubstr("--sort"));
  ReadFindings findings;
  const Trajectory poses = read_text(text, {.sort = true, .findings = &findings});
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(4, 5, 6));
  EXPECT_EQ(poses[2].stamp, 3.0);
  EXPECT_EQ(findings.unsorted, 1u);
  EXPECT_THAT(why(text + "1.0 4 5 6 0 0 0.6 0.8\n", {.sort = true}), HasSubstr("in two rows"));
}

TEST(InvalidRows, AreDroppedAndCounted) {
  ReadFindings findings;
  const ReadOptions options{.drop_invalid = true, .findings = &findings};
  const std::string tum = "1.0" + std::string(kPose) +
                          "2.0 nan nan nan nan nan nan nan\n3.0 1 2 3 " + "0 0 0 0\n4.0" + kPose;
  EXPECT_THAT(why(tum), HasSubstr(":2: column 2 (tx): 'nan' is not finite"));
  EXPECT_THAT(why(tum), HasSubstr("--drop-invalid"));
  EXPECT_EQ(read_text(tum, options).size(), 2u);
  EXPECT_EQ(findings.invalid, 2u);
  const std::string csv = "t,x,y,z,qx,qy,qz,qw\n1.0,1,2,3,0,0,0.6,0.8\n2.0,,,,,,,\n";
  EXPECT_THAT(why(csv), HasSubstr("column 2 (x): '' is not a number"));
  EXPECT_EQ(read_text(csv, options).size(), 1u);
  // Rows of KITTI keep their times.
  const Trajectory kitti = read_text("1 0 0 1 0 1 0 2 0 0 1 3\n" +
                                         std::string("nan nan nan nan nan nan nan nan nan nan ") +
                                         "nan nan\n1 0 0 1 0 1 0 2 0 0 1 3\n",
                                     options);
  EXPECT_EQ(kitti.back().stamp, 0.2);
}

TEST(Matrices, WithStampsFramesAndLastRow) {
  const std::string matrix = " 1 0 0 1 0 1 0 2 0 0 1 3";
  EXPECT_EQ(read_text("1604644894000000000" + matrix + "\n").front().stamp, 1604644894.0);
  EXPECT_EQ(read_text(matrix.substr(1) + " 0 0 0 1\n").size(), 1u);
  const std::string frames = "1" + matrix + "\n4" + matrix + "\n";
  ReadFindings findings;
  EXPECT_EQ(read_text(frames, {.findings = &findings}).back().stamp, 0.4);
  EXPECT_EQ(findings.clock, Clock::ids);
  const TemporaryFolder scratch;
  const ReadOptions timed{.times = scratch.file("times.txt", "0\n1.5\n2\n3\n4.5\n")};
  const Trajectory poses = read_text(frames, timed);
  EXPECT_EQ(poses.front().stamp, 1.5);
  EXPECT_EQ(poses.back().stamp, 4.5);
}

TEST(Clocks, DifferentNumbersOfRowsHaveNoCommonTime) {
  const FileClock rows{"a", Clock::rows, 3}, fewer{"b", Clock::rows, 2}, ids{"c", Clock::ids, 2};
  const FileClock stamps{"d", Clock::stamps, 2};
  EXPECT_EQ(why_no_common_time(rows, rows), "");
  EXPECT_EQ(why_no_common_time(ids, ids), "");
  EXPECT_EQ(why_no_common_time(stamps, stamps), "");
  EXPECT_THAT(why_no_common_time(rows, fewer), HasSubstr("a has 3 rows and b has 2"));
  EXPECT_THAT(why_no_common_time(stamps, rows), HasSubstr("a has no stamps, and d has"));
}

TEST(NamedColumns, AreObeyed) {
  const std::string pose = "1,2,3,0,0,0.6,0.8";
  ReadFindings findings;
  const ReadOptions options{.findings = &findings};
  const std::string seasons =
      "# frame_id, translation_x, translation_y, translation_z, quaternion_x, quaternion_y, "
      "quaternion_z, quaternion_w, scale, v3\n1604644894000000000," +
      pose + ",1.0,1\n";
  const Trajectory named = read_text(seasons, options);
  EXPECT_EQ(named.front().stamp, 1604644894.0);
  EXPECT_EQ(named.front().world_from_body.rotation.w(), 0.8);
  EXPECT_EQ(findings.ignored_columns, "scale, v3");
  EXPECT_EQ(
      read_text("Name TimeStamp POS_X POS_Y POS_Z Q_X Q_Y Q_Z Q_W\nDrone 1.5" + std::string(kPose))
          .front()
          .stamp,
      1.5);
  EXPECT_EQ(read_text("image,x,y,z,qx,qy,qz,qw\nrgb/1604644894100000000.png," + pose + "\n")
                .front()
                .stamp,
            1604644894.1);
  EXPECT_EQ(
      read_text("frame,x,y,z,qx,qy,qz,qw\n1," + pose + "\n4," + pose + "\n", options).back().stamp,
      0.4);
  EXPECT_EQ(findings.clock, Clock::ids);
  read_text(
      "%time,field.header.stamp,x,y,z,qx,qy,qz,qw\n1604644894014726334,"
      "1604644894000000000," +
          pose + "\n",
      options);
  EXPECT_EQ(findings.time_column, "field.header.stamp, not %time");
  EXPECT_EQ(read_text("1604644894,500000000,odom,base," + pose + ",0,0\n").front().stamp,
            1604644894.5);  // ros2 topic echo --csv
}

TEST(KnownLayouts, AreRefusedByName) {
  EXPECT_THAT(why("# Image list\n1 0.8 0 0 0.6 1 2 3 1 a.png\n\n"), HasSubstr("COLMAP"));
  EXPECT_THAT(why("1 2 3 0 0 0.6 0.8\n"), HasSubstr("7 columns"));
  EXPECT_THAT(why("[{\"t\": 1}]\n"), HasSubstr("is JSON"));
}

}  // namespace
}  // namespace loopbench::stamp_unit_test
