// Headers of rotation vectors, Euler angles in a stated order, Applanix, Aria; sentences of NMEA.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::angle_headers_test {
namespace {

using testing::HasSubstr;

Trajectory read_text(const std::string& text, bool positions = false) {
  const TemporaryFolder scratch;
  ReadOptions options;
  options.positions = positions;
  return read_trajectory(scratch.file("a.csv", text), options);
}

Pose first_of(const std::string& text) { return read_text(text).at(0).world_from_body; }

void expect_rotation(const Pose& pose, const Rotation& expected) {
  EXPECT_NEAR(angle_between(pose.rotation, expected), 0.0, 1e-9);
  EXPECT_EQ(pose.translation, Vector3(1, 2, 3));
}

TEST(AngleHeaders, RotationVectors) {
  expect_rotation(first_of("t,x,y,z,rvec_x,rvec_y,rvec_z\n0.5,1,2,3,0.1,-0.2,0.3\n"),
                  exp_so3({0.1, -0.2, 0.3}));
}

TEST(AngleHeaders, EulerAnglesInTheStatedOrder) {
  const Rotation x = exp_so3({0.1, 0, 0}), y = exp_so3({0, 0.2, 0}), z = exp_so3({0, 0, 0.3});
  const std::string row = "\n0.5,1,2,3,0.1,0.2,0.3\n";
  expect_rotation(first_of("t,x,y,z,roll,pitch,yaw" + row), z * y * x);
  expect_rotation(first_of("t,x,y,z,roll [zyx],pitch [zyx],yaw [zyx]" + row), z * y * x);
  expect_rotation(first_of("t,x,y,z,roll [rad xyz],pitch [rad],yaw [rad]" + row), x * y * z);
  expect_rotation(first_of("t,x,y,z,roll [rad yxz],pitch,yaw" + row), y * x * z);
  EXPECT_THAT(refusal([&] { read_text("t,x,y,z,roll [xyz],pitch,yaw [zyx]" + row); }),
              HasSubstr("different orders of angles: xyz, zyx"));
}

TEST(AngleHeaders, Applanix) {
  expect_rotation(
      first_of("GPSTime,easting,northing,altitude,vel_east,vel_north,vel_up,roll,pitch,heading\n"
               "0.5,1,2,3,9,9,9,0.1,0.2,0.3\n"),
      exp_so3({0, 0, 0.3}) * exp_so3({0, 0.2, 0}) * exp_so3({0.1, 0, 0}));
}

TEST(AngleHeaders, Aria) {
  const std::string names =
      "graph_uid,tracking_timestamp_us,utc_timestamp_ns,tx_world_device,ty_world_device,"
      "tz_world_device,qx_world_device,qy_world_device,qz_world_device,qw_world_device,"
      "device_linear_velocity_x_device,quality_score\n";
  const Trajectory poses = read_text(
      names + "a1b2,500000,-1,1,2,3,0,0,0.6,0.8,0.1,1\na1b2,600000,-1,1,2,3,0,0,0.6,0.8,0.1,1\n");
  EXPECT_EQ(poses.at(0).stamp, 0.5);
  expect_rotation(poses[0].world_from_body, Rotation(0.8, 0, 0, 0.6));
}

TEST(Nmea, SentencesWithAPosition) {
  const std::string text =
      "$GPRMC,235959.000,A,4806.000,N,01130.000,E,0.0,0.0,311222,,\n"
      "$GPGGA,235959.000,4806.000,N,01130.000,E,1,08,1.0,500.0,M,46.0,M,,\n"
      "$GPGSV,1,1,00\n"
      "$GPGGA,000000.500,4806.060,N,01130.000,E,1,08,1.0,501.0,M,46.0,M,,\n"
      "$GPGGA,000001.500,,,,,0,00,,,M,,M,,\n";
  const Trajectory poses = read_text(text, true);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].stamp, 1672531199.0);  // 2022-12-31 23:59:59 UTC
  EXPECT_EQ(poses[1].stamp, 1672531200.5);
  EXPECT_FALSE(has_rotation(poses[0].world_from_body));
  EXPECT_NEAR(poses[1].world_from_body.translation.y(), 111.2, 0.2);  // a minute's 0.06 north
  EXPECT_NEAR(poses[1].world_from_body.translation.z(), 1.0, 0.01);
  EXPECT_THAT(refusal([&] { read_text(text); }), HasSubstr("positions without rotation"));
}

TEST(Nmea, AWrongChecksumIsAnInvalidRow) {
  const std::string text = "$GPGGA,233659.103,5142.945,N,00016.351,W,1,12,1.0,0.0,M,0.0,M,,*7C\n";
  EXPECT_EQ(read_text(text, true).size(), 1u);
  std::string wrong = text;
  wrong[20] = '9';
  EXPECT_THAT(refusal([&] { read_text(wrong, true); }), HasSubstr("has checksum 7C"));
}

std::string gga(const std::string& time, const std::string& latitude = "4806.000") {
  return "$GPGGA," + time + "," + latitude + ",N,01130.000,E,1,08,1.0,500.0,M,46.0,M,,\n";
}

std::string rmc(const std::string& time, const std::string& date, const char* status = "A") {
  return "$GPRMC," + time + "," + status + ",4806.000,N,01130.000,E,0.0,0.0," + date + ",,\n";
}

std::vector<double> stamps_of(const std::string& text) {
  std::vector<double> out;
  for (const StampedPose& pose : read_text(text, true)) out.push_back(pose.stamp);
  return out;
}

constexpr double kDay = 86'400.0, kJanuary = 1'704'067'200.0;  // 2024-01-01

TEST(Nmea, PositionsBeforeTheFirstDateAreOfTheDayBefore) {
  EXPECT_THAT(
      stamps_of(gga("235950") + gga("000010") + rmc("000010", "020124") + gga("000011")),
      testing::ElementsAre(kJanuary + 86'390.0, kJanuary + kDay + 10.0, kJanuary + kDay + 11.0));
  EXPECT_THAT(stamps_of(gga("235950") + rmc("000000", "020124")),
              testing::ElementsAre(kJanuary + 86'390.0));
}

TEST(Nmea, EachDateCounts) {
  const auto first = rmc("100000", "010124"), later = rmc("110000", "020124"),
             earlier = rmc("090000", "020124");
  const double at = kJanuary + 36'000.0;
  EXPECT_THAT(stamps_of(first + later), testing::ElementsAre(at, at + kDay + 3600.0));
  EXPECT_THAT(stamps_of(first + earlier), testing::ElementsAre(at, at + kDay - 3600.0));
  EXPECT_THAT(stamps_of(first + gga("100000") + later + gga("110001")),
              testing::ElementsAre(at, at + kDay + 3601.0));
  // That of a receiver without a fix counts only if there is no other.
  EXPECT_THAT(stamps_of(rmc("095900", "010124", "V") + gga("100000") + rmc("1", "060180", "V") +
                        gga("100001")),
              testing::ElementsAre(at, at + 1.0));
}

TEST(Nmea, DatesOfOtherCharactersAreNone) {
  for (const char* const date : {"1e+300", "-12345", "311322"}) {
    EXPECT_THAT(stamps_of(rmc("000001", date)), testing::ElementsAre(1.0)) << date;
  }
}

TEST(Nmea, NumbersOutOfRangeAreRefused) {
  for (const char* const latitude : {"9930.0", "nan", "1e300"}) {
    EXPECT_THAT(refusal([&] { read_text(gga("000001", latitude), true); }),
                HasSubstr("expected -90 to 90 degrees"));
  }
  std::string high = gga("000001");
  high.replace(high.find("500.0"), 5, "nan");
  EXPECT_THAT(refusal([&] { read_text(high, true); }), HasSubstr("height is nan"));
  for (const char* const time : {"1e300", "240000", "-1", "nan"}) {
    EXPECT_THAT(stamps_of(gga("000001") + gga(time)), testing::ElementsAre(1.0)) << time;
  }
}

TEST(Nmea, SentencesWithoutAPositionAreCounted) {
  const TemporaryFolder scratch;
  ReadOptions options;
  options.positions = true;
  const auto without_fix = [&](const std::string& text) {
    ReadFindings findings;
    options.findings = &findings;
    read_trajectory(scratch.file("a.csv", text), options);
    return findings.without_fix;
  };
  const std::string lost = "$GPGGA,000002,,,,,0,00,,,M,,M,,\n$GPRMC,000002,V,,,,,,,010124,,\n";
  EXPECT_EQ(without_fix(gga("000001") + lost), 1u);
  EXPECT_EQ(without_fix(rmc("000001", "010124") + lost), 1u);
}

TEST(Nmea, AFileBeginsWithAReceiversOwnSentence) {
  for (const char* const own : {"$PUBX,00,1,2,3\n", "$PMTK010,001*2E\n", "$PGRMC,A,0,0\n"}) {
    EXPECT_THAT(stamps_of(own + gga("000001")), testing::ElementsAre(1.0)) << own;
  }
}

}  // namespace
}  // namespace loopbench::angle_headers_test
