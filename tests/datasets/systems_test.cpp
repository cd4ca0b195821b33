/// Files as SLAM systems and public datasets write them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "datasets/core/so3.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::systems_test {
namespace {

TEST(Systems, OkvisAndTrajectopyNameColumnsInTheirWay) {
  const TemporaryFolder scratch;
  const auto okvis = scratch.file(
      "okvis.csv",
      "timestamp, p_WS_W_x, p_WS_W_y, p_WS_W_z, q_WS_x, q_WS_y, q_WS_z, q_WS_w, v_WS_W_x\n"
      "1700000000012345678, 1, 2, 3, 0, 0, 0, 1, 9,\n1700000000112345678, 1, 2, 4, 0, 0, 0, 1, "
      "9,\n");
  const auto trajectopy =
      scratch.file("b.traj",
                   "#epsg 0\n#name B\n#fields t,l,px,py,pz,qx,qy,qz,qw,vx,vy,vz\n"
                   "0,0,1,2,3,0,0,0,1,7,8,9\n1,0,1,2,4,0,0,0,1,7,8,9\n");
  for (const auto& file : {okvis, trajectopy}) {
    const Trajectory poses = read_trajectory(file);
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[1].world_from_body.translation, Vector3(1, 2, 4));
    EXPECT_EQ(poses[1].world_from_body.rotation.w(), 1.0);
  }
}

/// Two poses in the layouts in which public datasets publish their references.
TEST(Systems, ReferencesOfPublicDatasetsAreReadAsTheyAre) {
  const TemporaryFolder scratch;
  const auto newer_college =
      scratch.file("registered_poses.csv",
                   "#sec,nsec,x,y,z,qx,qy,qz,qw\n1583836591,500000000,1,2,3,0,0,0,1\n"
                   "1583836592,0,1,2,4,0,0,0.6,0.8\n");
  const auto mulran = scratch.file("global_pose.csv",
                                   "1583836591500000000,1,0,0,1,0,1,0,2,0,0,1,3\n"
                                   "1583836592000000000,0.28,-0.96,0,1,0.96,0.28,0,2,0,0,1,4\n");
  const auto helipr = scratch.file("Ouster_gt.txt",
                                   "1583836591500000000 1 2 3 0 0 0 1\n"
                                   "1583836592000000000 1 2 4 0 0 0.6 0.8\n");
  const auto mcd =
      scratch.file("pose_inW.csv",
                   "num, t, x, y, z, qx, qy, qz, qw\n0, 1583836591.5, 1, 2, 3, 0, 0, 0, "
                   "1\n1, 1583836592, 1, 2, 4, 0, 0, 0.6, 0.8\n");
  for (const auto& file : {newer_college, mulran, helipr, mcd}) {
    const Trajectory poses = read_trajectory(file);
    ASSERT_EQ(poses.size(), 2u) << file;
    EXPECT_EQ(poses[0].stamp, 1583836591.5) << file;
    EXPECT_EQ(poses[1].stamp, 1583836592.0) << file;
    EXPECT_EQ(poses[1].world_from_body.translation, Vector3(1, 2, 4)) << file;
    EXPECT_NEAR(poses[1].world_from_body.rotation.z(), 0.6, 1e-12) << file;
  }
}

TEST(Systems, RtabmapExportsPosesWithIds) {
  const TemporaryFolder scratch;
  const Trajectory poses = read_trajectory(
      scratch.file("format11.txt", "1.5 1 2 3 0 0 0 1 7\n2.0 1 2 4 0 0 0.6 0.8 9\n"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].stamp, 2.0);
  EXPECT_EQ(poses[1].world_from_body.translation, Vector3(1, 2, 4));
}

/// The command that the error states converts the file.
TEST(Systems, RotationVectorsOfArkitScenes) {
  const TemporaryFolder scratch;
  const Vector3 first(0.3, -1.2, 0.7);
  const auto row = [](double stamp, const Vector3& r) {
    return fmt::format("{} {} {} {} 4 5 6\n", stamp, r.x(), r.y(), r.z());
  };
  const auto file = scratch.file("room.traj", row(10.5, first) + row(11.0, Vector3::Zero()));
  const std::string why = refusal([&] { read_trajectory(file); });
  ASSERT_NE(why.find("room.traj:1: has 7 columns in a .traj file as of ARKitScenes"), why.npos);
  const auto rows = scratch.path() / "rows.txt";
  std::string command = why.substr(why.find("awk"));
  command = command.substr(0, command.find(" > ")) + " > " + rows.string();
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const Trajectory poses = read_trajectory(rows);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].stamp, 10.5);
  EXPECT_LT(angle_between(poses[0].world_from_body.rotation, exp_so3(first)), 1e-9);
  EXPECT_LT(angle_between(poses[1].world_from_body.rotation, Rotation::Identity()), 1e-9);
  EXPECT_EQ(poses[1].world_from_body.translation, Vector3(4, 5, 6));
}

TEST(Systems, DecimalCommasAreNamed) {
  const TemporaryFolder scratch;
  for (const char* line :
       {"0,5 0 0 0 0 0 0 1", "1,0 0,5 0,2 0,1 0 0 0 1", "VERTEX_SE3:QUAT 0 1,5 0,0 0,0 0 0 0 1"}) {
    const auto comma = scratch.file("comma.txt", std::string(line) + "\n");
    EXPECT_NE(refusal([&] { read_trajectory(comma); }).find("comma.txt:1: has decimal commas"),
              std::string::npos)
        << line;
  }
  const auto dated = scratch.file("dated.csv", "2024-05-01 10:00:00,1,2,3,0,0,0,1\n");
  EXPECT_EQ(refusal([&] { read_trajectory(dated); }).find("decimal commas"), std::string::npos);
}

TEST(Systems, StampedMatricesNameRowsThatAreWrong) {
  const TemporaryFolder scratch;
  const std::string row = ",1,0,0,1,0,1,0,2,0,0,1,3\n";
  const auto shorter = scratch.file("a.csv", "1583836591500000000" + row + "1,2\n");
  EXPECT_NE(refusal([&] { read_trajectory(shorter); }).find("a.csv:2: has 2 columns, expected 13"),
            std::string::npos);
  const auto late =
      scratch.file("b.csv", "1583836591500000000" + row + "1583836591400000000" + row);
  EXPECT_NE(refusal([&] { read_trajectory(late); }).find("b.csv:2: "), std::string::npos);
}

}  // namespace
}  // namespace loopbench::systems_test
