// Headers and comments that name the columns of a trajectory, with units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::csv_header_test {
namespace {

using testing::HasSubstr;

const Rotation kRotation(0.8, 0.0, 0.0, 0.6);  // w x y z

/// Reads a header and rows, and expects the pose (1, 2, 3) with kRotation at 0.5 s in the first
/// row.
TrajectoryFile read_rows(const std::string& text) {
  const TemporaryFolder scratch;
  const TrajectoryFile out = read_trajectory_file(scratch.file("a.csv", text));
  EXPECT_EQ(out.poses[0].stamp, 0.5) << text;
  EXPECT_EQ(out.nanoseconds.at(0), 500'000'000) << text;
  EXPECT_EQ(out.poses[0].world_from_body.translation, Vector3(1, 2, 3)) << text;
  EXPECT_EQ(out.poses[0].world_from_body.rotation.coeffs(), kRotation.coeffs()) << text;
  return out;
}

std::string reason(const std::string& text) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.csv", text);
  return refusal([&] { read_trajectory(file); }).substr(file.string().size());
}

TEST(CsvHeader, UnitsOfTimeAndPositionAreApplied) {
  for (const char* const time : {"t_ns", "tns", "time [ns]", "timestamp_ns", "nanoseconds"}) {
    read_rows(std::string(time) + ",x,y,z,qw,qx,qy,qz\n500000000,1,2,3,0.8,0,0,0.6\n");
  }
  for (const char* const time : {"t_us", "utime", "timeus", "timestamp (us)", "time [\u00b5s]"}) {
    read_rows(std::string(time) + ",x,y,z,qw,qx,qy,qz\n500000,1,2,3,0.8,0,0,0.6\n");
  }
  for (const char* const time : {"time_ms", "timestamp [ms]", "ms"}) {
    read_rows(std::string(time) + ",x,y,z,qw,qx,qy,qz\n500,1,2,3,0.8,0,0,0.6\n");
  }
  read_rows("epoch,x [mm],y [cm],p_z_mm,qw,qx,qy,qz\n0.5,1000,200,3000,0.8,0,0,0.6\n");
  EXPECT_EQ(reason("time [min],x,y,z,qw,qx,qy,qz\n1,1,2,3,0.8,0,0,0.6\n"),
            ": has a header with unit min in 'time [min]', expected s, ms, us or ns");
  EXPECT_EQ(reason("t,x [ft],y,z,qw,qx,qy,qz\n1,1,2,3,0.8,0,0,0.6\n"),
            ": has a header with unit ft in 'x [ft]', expected m, cm or mm");
}

TEST(CsvHeader, NanosecondsAreAddedToSeconds) {
  for (const char* const names :
       {"secs,nsecs", "sec,nanosec", "header.stamp.secs,header.stamp.nsecs"}) {
    const TrajectoryFile file = read_rows(std::string(names) +
                                          ",x,y,z,qx,qy,qz,qw\n0,500000000,1,2,3,0,0,0.6,0.8\n"
                                          "1403715273,262142976,1,2,3,0,0,0.6,0.8\n");
    EXPECT_EQ(file.nanoseconds[1], 1403715273262142976);
  }
  // The stamp of the message rather than the time of the recording.
  read_rows(
      "Time,header.stamp.secs,header.stamp.nsecs,x,y,z,qx,qy,qz,qw\n"
      "7,0,500000000,1,2,3,0,0,0.6,0.8\n");
  EXPECT_EQ(reason("secs,nsecs,x,y,z,qx,qy,qz,qw\n5,1000000000,1,2,3,0,0,0.6,0.8\n"),
            ":2: stamp has '5' s and '1000000000' ns, expected whole seconds and nanoseconds from "
            "0 to 999999999");
  EXPECT_THAT(reason("time,nsecs,x,y,z,qx,qy,qz,qw\n5,1,1,2,3,0,0,0.6,0.8\n"),
              HasSubstr("time in 'time' and 'nsecs', expected one, or secs and nsecs"));
}

TEST(CsvHeader, NamesOfQuaternions) {
  for (const char* const names : {"q_x,q_y,q_z,q_w",
                                  "qi,qj,qk,qw",
                                  "q_i,q_j,q_k,q_w",
                                  "rx,ry,rz,rw",
                                  "ori_x,ori_y,ori_z,ori_w"}) {
    read_rows("t,pos_x,pos_y,pos_z," + std::string(names) + "\n0.5,1,2,3,0,0,0.6,0.8\n");
  }
  for (const char* const names : {"q0,q1,q2,q3", "q[0],q[1],q[2],q[3]"}) {
    read_rows("t,x,y,z," + std::string(names) + "\n0.5,1,2,3,0.8,0,0,0.6\n");
  }
  read_rows(
      "frame,pose.orientation.w,pose.orientation.x,pose.orientation.y,pose.orientation.z,"
      "pose.position.x,pose.position.y,pose.position.z,time [ns]\n7,0.8,0,0,0.6,1,2,3,500000000\n");
  // A rotation vector next to a quaternion.
  read_rows("t,x,y,z,rx,ry,rz,qw,qx,qy,qz\n0.5,1,2,3,9,9,9,0.8,0,0,0.6\n");
}

TEST(CsvHeader, OnlyAnUnknownFirstColumnIsTheTime) {
  read_rows("clock,x,y,z,qx,qy,qz,qw\n0.5,1,2,3,0,0,0.6,0.8\n");
  read_rows("clock_ms,x,y,z,qx,qy,qz,qw\n500,1,2,3,0,0,0.6,0.8\n");
  EXPECT_THAT(reason("clock,a,x,y,z,qx,qy,qz,qw\n0.5,0,1,2,3,0,0,0.6,0.8\n"),
              HasSubstr(": has a header without time (unknown: clock, a), expected time (t, "));
  EXPECT_THAT(reason("1403715273262142976_,a,b,c,d,e,f,g\n1403715273262142976,1,2,3,1,0,0,0\n"),
              HasSubstr("expected tum"));
  EXPECT_THAT(
      reason("t,a,b,c,d,e,f,g\n1403715273262142976,1,2,3,1,0,0,0\n"),
      HasSubstr("without x, y, z, qw, qx, qy, qz (unknown: a, b, c, d, e, f, ...), expected"));
  EXPECT_EQ(reason("t,x,tx,y,z,qx,qy,qz,qw\n0.5,1,1,2,3,0,0,0.6,0.8\n"),
            ": has a header with two columns for x: x and tx");
}

TEST(CsvHeader, EmptyNamesQuotesAndEmptyColumns) {
  read_rows(",timestamp,x,y,z,qx,qy,qz,qw\n0,0.5,1,2,3,0,0,0.6,0.8\n");
  read_rows(
      "\"timestamp\",\"x\",\"y\",\"z\",\"qx\",\"qy\",\"qz\",\"qw\"\n"
      "\"0.5\",\"1\",\"2\",\"3\",\"0\",\"0\",\"0.6\",\"0.8\"\n");
  read_rows("t,frame_id,x,y,z,qx,qy,qz,qw,remark\n0.5,,1,2,3,0,0,0.6,0.8,\n");
  EXPECT_EQ(reason("t,x,y,z,qx,qy,qz,qw\n0.5,\"1,5\",2,3,0,0,0.6,0.8\n"),
            ":2: column x: '1,5' is not a number");
  EXPECT_EQ(reason("t,x,y,z,qx,qy,qz,qw\n0.5,1,2,3,0,0,0.6\n"),
            ":2: has 7 columns, expected 8 as in the header");
  EXPECT_EQ(reason("t;x;y;z;qx;qy;qz;qw\n0.5;1;2;3;0;0;0.6;0.8\n"),
            ":1: has 1 column and starts 't;x;y;z;qx;qy;qz;qw': found ';', expected columns "
            "separated by commas or blanks");
}

TEST(CsvHeader, ACommentAboveTheDataDecidesTheOrder) {
  read_rows("# time,x,y,z,qw,qx,qy,qz\n0.5,1,2,3,0.8,0,0,0.6\n");
  read_rows("# made by a tool\n# timestamp tx ty tz qw qx qy qz\n0.5 1 2 3 0.8 0 0 0.6\n");
  read_rows("# timestamp [ms] x [m] y [m] z [m] qw qx qy qz\n500 1 2 3 0.8 0 0 0.6\n");
  const auto tum = read_rows("# timestamp tx ty tz qx qy qz qw\n0.5 1 2 3 0 0 0.6 0.8\n");
  EXPECT_EQ(tum.format, Format::tum);
  // Another number of columns: no names of these columns.
  read_rows("# stamps, then t x y z qw qx qy qz\n0.5 1 2 3 0 0 0.6 0.8\n");
}

TEST(CsvHeader, WrittenEurocFilesAreReadBack) {
  const TemporaryFolder scratch;
  const Pose pose{kRotation, {1, 2, 3}};
  for (const Trajectory& poses : {Trajectory{{-100.0, pose}, {-99.5, pose}},
                                  Trajectory{{0.0, pose}},
                                  Trajectory{{-0.5, pose}, {0.5, pose}}}) {
    write_trajectory(scratch.path() / "a.csv", {poses}, Format::euroc);
    const Trajectory read = read_trajectory(scratch.path() / "a.csv");
    ASSERT_EQ(read.size(), poses.size());
    EXPECT_EQ(read.back().stamp, poses.back().stamp);
    EXPECT_EQ(read.back().world_from_body.rotation.coeffs(), kRotation.coeffs());
  }
}

}  // namespace
}  // namespace loopbench::csv_header_test
