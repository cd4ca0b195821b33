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

}  // namespace
}  // namespace loopbench::angle_headers_test
