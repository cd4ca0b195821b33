// Positions without rotation: every format, local coordinates of WGS 84, and files that mix both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/bags/messages.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::positions_test {
namespace {

using testing::HasSubstr;

Trajectory read(const std::filesystem::path& file, ReadFindings* findings = nullptr) {
  return read_trajectory(file, {.positions = true, .findings = findings});
}

std::string reason(const std::string& text) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.csv", text);
  return refusal([&] { read(file); }).substr(file.string().size());
}

TEST(Positions, AreReadInEveryTextFormat) {
  const TemporaryFolder scratch;
  const char* const leica =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n"
      "500000000,1,2,3\n1000000000,4,5,6\n";
  for (const char* const text : {"0.5 1 2 3\n1 4 5 6\n",                  // TUM
                                 "0.5 1 2 3 0 0 0 0\n1 4 5 6 0 0 0 0\n",  // M2DGR
                                 "500000000,1,2,3\n1000000000,4,5,6\n",   // small clocks
                                 "t,x,y,z\n0.5,1,2,3\n1,4,5,6\n",         // csv
                                 leica}) {
    const Trajectory poses = read(scratch.file("a.txt", text));
    ASSERT_EQ(poses.size(), 2u) << text;
    EXPECT_EQ(poses[0].stamp, 0.5) << text;
    EXPECT_EQ(poses[1].world_from_body.translation, Vector3(4, 5, 6)) << text;
    EXPECT_TRUE(lacks_rotations(poses)) << text;
    check(poses, "positions", Rotations::optional);
    EXPECT_THROW(check(poses, "positions"), InputError);
    EXPECT_THROW(read_trajectory(scratch.file("a.txt", text)), InputError) << text;
  }
  const auto euroc =
      scratch.file("b.csv", "1403636578922881280,1,2,3\n1403636578968881408,4,5,6\n");
  EXPECT_EQ(detect_format(euroc), Format::euroc);
  EXPECT_TRUE(lacks_rotations(read(euroc)));
}

TEST(Positions, AreWrittenAndReadBack) {
  const TemporaryFolder scratch;
  const Trajectory poses = read(scratch.file("a.txt", "0.5 1 2 3\n1 4 5 6\n"));
  for (const Format format : {Format::tum, Format::csv}) {
    const auto file = scratch.path() / "b";
    write_trajectory(file, {.poses = poses}, format);
    const Trajectory again = read(file);
    ASSERT_EQ(again.size(), 2u);
    EXPECT_TRUE(lacks_rotations(again));
    EXPECT_EQ(again[1].world_from_body.translation, Vector3(4, 5, 6));
  }
  EXPECT_EQ(read_all(scratch.path() / "b"), "timestamp,x,y,z\n0.5,1,2,3\n1,4,5,6\n");
  EXPECT_THAT(refusal([&] { write_trajectory("c", {.poses = poses}, Format::kitti); }),
              HasSubstr("kitti needs rotations, expected tum or csv"));
}

TEST(Positions, ARowOfTheOtherKindIsRejectedWithItsLine) {
  EXPECT_EQ(reason("1 1 2 3\n2 1 2 3 0 0 0 1\n"),
            ":2: has 8 columns, expected 4 as in the first row: stamp x y z");
  EXPECT_EQ(reason("1 1 2 3 0 0 0 1\n2 1 2 3\n"),
            ":2: has 4 columns (stamp x y z?): the first row has a rotation, expected 8: stamp tx "
            "ty tz qx qy qz qw");
  EXPECT_EQ(reason("1 1 2 3 0 0 0 0\n2 1 2 3 0 0 0 1\n"),
            ":2: has a rotation, expected a zero quaternion (positions without rotation) as in the "
            "rows above (or --drop-invalid)");
  EXPECT_EQ(reason("1 1 2 3 0 0 0 1\n2 1 2 3 0 0 0 0\n"),
            ":2: quaternion is zero, expected norm 1 as in the rows above (--drop-invalid, or "
            "drop_invalid: true in a config)");
  EXPECT_EQ(reason("t,x,y,z,qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n2,1,2,3,0,0,0,0\n"),
            ":3: quaternion is zero, expected norm 1 as in the rows above (--drop-invalid, or "
            "drop_invalid: true in a config)");
  EXPECT_THAT(reason("t,x,y,z,qx,qy\n1,1,2,3,0,0\n"), HasSubstr("a header without qw, qz"));
}

TEST(Positions, MetresInPlaceOfDegreesAreRejectedWithTheirLine) {
  EXPECT_EQ(reason("t,lat,lon,alt\n1,47,8,400\n2,5242729,255855,643\n"),
            ":3: latitude is 5242729, expected -90 to 90 degrees (coordinates in metres have "
            "columns x, y, z)");
  EXPECT_EQ(reason("t,lat,lon,alt\n1,47,400,400\n"),
            ":2: longitude is 400, expected -180 to 360 degrees (coordinates in metres have "
            "columns x, y, z)");
  EXPECT_THAT(reason("t,lat,lon,alt\n1,47,8,1e300\n"), HasSubstr(":2: height is 1e+300, expected"));
  EXPECT_THAT(reason("t,lat [rad],lon,alt\n1,0.5,1,2\n"), HasSubstr("unit rad"));
  EXPECT_THAT(reason("t,lat,alt\n1,47,400\n"), HasSubstr("header without "));
}

bool has_geographiclib() {
  try {
    to_local({}, {});
    return true;
  } catch (const MissingPart&) {
    return false;
  }
}

TEST(Positions, LatitudeLongitudeAndHeightBecomeLocal) {
  if (!has_geographiclib()) GTEST_SKIP() << "built without GeographicLib";
  const TemporaryFolder scratch;
  ReadFindings findings;
  // One degree on the equator is 6378137 pi / 180 m = 111.319 km; across the antimeridian.
  const Trajectory equator = read(
      scratch.file("a.csv",
                   "t,latitude,longitude,height\n1,0,179.9999,0\n2,0,-179.9999,0\n3,0,180,5\n"),
      &findings);
  EXPECT_NEAR(equator[1].world_from_body.translation.x(), 22.2639, 1e-4);
  EXPECT_NEAR(equator[2].world_from_body.translation.z(), 5.0, 1e-4);
  ASSERT_TRUE(findings.origin);
  EXPECT_THAT(to_text(*findings.origin), HasSubstr("WGS 84"));
  // At the pole, the meridian's radius of curvature is a^2 / b = 6399593.6 m: 1e-5 deg are 1.11694
  // m.
  const Trajectory pole =
      read(scratch.file("b.csv", "t,lat,lon,alt\n1,90,0,0\n2,89.99999,90,0\n3,89.99999,-90,0\n"));
  const auto& a = pole[1].world_from_body.translation;
  const auto& b = pole[2].world_from_body.translation;
  EXPECT_NEAR(a.head<2>().norm(), 1.11694, 1e-5);
  EXPECT_NEAR((a - b).norm(), 2.0 * 1.11694, 1e-5);
}

TEST(Positions, RowsOfANavSatFixWithoutFixAreSkippedAndCounted) {
  if (!has_geographiclib()) GTEST_SKIP() << "built without GeographicLib";
  const TemporaryFolder scratch;
  ReadFindings findings;
  const Trajectory poses = read(scratch.file("a.csv",
                                             "%time,field.status.status,field.latitude,"
                                             "field.longitude,field.altitude\n"
                                             "1,0,47,8,400\n2,-1,nan,nan,nan\n3,0,47,8,401\n"),
                                &findings);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(findings.without_fix, 1u);
  EXPECT_NEAR(poses[1].world_from_body.translation.z(), 1.0, 1e-8);
}

TEST(Positions, AFixOfARealBagBecomesLocal) {
  if (!has_geographiclib()) GTEST_SKIP() << "built without GeographicLib";
  const char* const folder = std::getenv("LOOPBENCH_DATA");
  if (folder == nullptr) GTEST_SKIP() << "LOOPBENCH_DATA is not set";
  const std::string bag = std::string(folder) + "/systems/robot_localization/test1.bag";
  if (!std::filesystem::exists(bag)) GTEST_SKIP() << bag << " is not there";
  const Trajectory fix = read("bag:" + bag + "#/fix");
  EXPECT_EQ(fix.size(), 989u);
  EXPECT_LT(path_length(fix), 1000.0);
  EXPECT_FALSE(lacks_rotations(read(bag)));  // the only topic with rotations
}

TEST(Positions, TypesOfMessages) {
  EXPECT_EQ(message_type("geometry_msgs/msg/PointStamped"), MessageType::point_stamped);
  EXPECT_EQ(message_type("sensor_msgs/NavSatFix"), MessageType::nav_sat_fix);
}

}  // namespace
}  // namespace loopbench::positions_test
