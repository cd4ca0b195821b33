// Units, digits and order of stamps, frames, and rows that are no poses.
#include "datasets/columns/stamp_unit.hpp"

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
  EXPECT_THAT(why(rows({"8646911284551352320", "8646911284551352321"})),
              HasSubstr("key of a pose in GTSAM"));
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
  EXPECT_EQ(read_text(rows({"1", "2", "2", "3"})).size(), 3u);  // one, whose pose agrees
}

TEST(InvalidRows, AreDroppedAndCounted) {
  ReadFindings findings;
  const ReadOptions options{.drop_invalid = true, .findings = &findings};
  const std::string tum = "1.0" + std::string(kPose) +
                          "2.0 nan nan nan nan nan nan nan\n3.0 1 2 3 " + "0 0 0 0\n4.0" + kPose;
  EXPECT_EQ(read_text(tum, options).size(), 2u);
  EXPECT_EQ(findings.invalid, 2u);
  const std::string csv = "t,x,y,z,qx,qy,qz,qw\n1.0,1,2,3,0,0,0.6,0.8\n2.0,,,,,,,\n";
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

}  // namespace
}  // namespace loopbench::stamp_unit_test
