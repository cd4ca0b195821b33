// Rows that readers repair or count, and headers that decide what columns mean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/columns/stamp_unit.hpp"
#include "datasets/formats/times.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::reading_rules_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Trajectory read_text(const std::string& text, ReadOptions options = {}) {
  const TemporaryFolder scratch;
  return read_trajectory(scratch.file("a.txt", text), options);
}

std::string why(const std::string& text, ReadOptions options = {}) {
  return refusal([&] { read_text(text, options); });
}

constexpr const char* kUnit = " 0 0 0 1\n";

TEST(StampUnits, DecimalsAreSeconds) {
  ReadFindings findings;
  const Trajectory poses = read_text(std::string("1000.0 0 0 0") + kUnit + "1000.5 1 0 0" + kUnit,
                                     {.findings = &findings});
  EXPECT_EQ(poses.back().stamp, 1000.5);
  EXPECT_THAT(findings.units, ElementsAre(StampUnit::s));
  // The other file from 0 on does not make them milliseconds.
  const Trajectory other{{0.0, {}}, {0.5, {}}};
  EXPECT_EQ(better_unit(poses, findings, other), StampUnit::automatic);
}

TEST(StampUnits, AStatedOffsetIsTriedBeforeAnotherUnit) {
  // Whole seconds from 1000 on: as milliseconds they would overlap with a file from 0 on.
  const Trajectory own{{1000.0, {}}, {1040.0, {}}}, other{{0.0, {}}, {40.0, {}}};
  const ReadFindings findings{.units = {StampUnit::s, StampUnit::ms}};
  EXPECT_EQ(better_unit(own, findings, other), StampUnit::ms);
  EXPECT_EQ(better_unit(own, findings, other, -1000.0), StampUnit::automatic);
}

TEST(RepeatedStamps, AreAcceptedIfThePosesAgree) {
  const std::string rows = std::string("0.0 0 0 0") + kUnit + "0.1 1 0 0" + kUnit;
  const std::string after = std::string("0.2 3 0 0") + kUnit;
  ReadFindings findings;
  const std::string agreeing = rows + "0.1 2.9 0 0" + kUnit + after;
  const Trajectory poses = read_text(agreeing, {.findings = &findings});
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[1].world_from_body.translation.x(), 1.0);  // the first
  EXPECT_EQ(findings.agreeing, 1u);
  // More than twice the motion before it; without motion, only the same pose agrees.
  EXPECT_THAT(why(rows + "0.1 3.1 0 0" + kUnit + after),
              HasSubstr(":3: stamp 0.1 is already on line 2 with another pose, expected increasing "
                        "stamps (--repeats keep_first or keep_last, or repeats: in a config)"));
  EXPECT_THAT(why(rows + "0.1 1 0 0 0 0 0.6 0.8\n" + after), HasSubstr("another pose"));
  EXPECT_THAT(why(std::string("0.0 0 0 0") + kUnit + "0.0 1 0 0" + kUnit + "0.5 2 0 0" + kUnit),
              HasSubstr("another pose"));
  // Sorted rows likewise.
  findings = {};
  EXPECT_EQ(read_text(after + agreeing.substr(0, agreeing.size() - after.size()),
                      {.sort = true, .findings = &findings})
                .size(),
            3u);
  EXPECT_EQ(findings.agreeing, 1u);
}

TEST(InvalidRows, KeepTheNumbersOfTheOthers) {
  ReadFindings findings;
  const ReadOptions options{.drop_invalid = true, .findings = &findings};
  const std::string pose = " 1 2 3 0 0 0.6 0.8\n";
  read_text("0.0" + pose + "0.1 nan nan nan 0 0 0 1\n0.2" + pose + "0.3 0 0 0 0 0 0 0\n0.4" + pose,
            options);
  EXPECT_EQ(findings.rows, 5u);
  EXPECT_THAT(findings.dropped, ElementsAre(1u, 3u));
  EXPECT_EQ(findings.invalid, 2u);
}

TEST(InvalidRows, KeepTheirNumbersInPartsOfLargeFiles) {
  std::string text;
  for (int i = 0; i < 120000; ++i) {
    const bool is_invalid = i == 7 || i == 99999;
    text += std::to_string(i) + (is_invalid ? ".5 nan 2.125 3.125" : ".5 1.125 2.125 3.125") +
            " 0 0 0.6 0.8\n";
  }
  ReadFindings findings;
  EXPECT_EQ(read_text(text, {.drop_invalid = true, .findings = &findings}).size(), 119998u);
  EXPECT_THAT(findings.dropped, ElementsAre(7u, 99999u));
  EXPECT_EQ(findings.rows, 120000u);
}

TEST(Matrices, WithFewDigitsAreNormalised) {
  ReadFindings findings;
  const Trajectory poses =
      read_text("0.62 -0.78 0 1 0.78 0.62 0 2 0 0 1 3\n", {.findings = &findings});
  EXPECT_NEAR(findings.off_orthonormal, 1.0 - 0.62 * 0.62 - 0.78 * 0.78, 1e-12);
  EXPECT_EQ(findings.scales.rows, 0u);
  const Rotation& q = poses.front().world_from_body.rotation;
  EXPECT_NEAR(q.norm(), 1.0, 1e-12);
  EXPECT_NEAR(2.0 * std::atan2(q.z(), q.w()), std::atan2(0.78, 0.62), 1e-12);
  EXPECT_THAT(why("0.7 -0.78 0 1 0.5 0.62 0 2 0 0 1 3\n"), HasSubstr("expected at most 0.05"));
}

TEST(Matrices, WithAScaleAreSimilarities) {
  ReadFindings findings;
  const Trajectory poses =
      read_text("0.24 -0.32 0 1 0.32 0.24 0 2 0 0 0.4 3\n", {.findings = &findings});
  EXPECT_EQ(findings.scales.rows, 1u);
  EXPECT_NEAR(findings.scales.least, 0.4, 1e-12);
  EXPECT_NEAR(findings.scales.largest, 0.4, 1e-12);
  EXPECT_EQ(poses.front().world_from_body.translation, Vector3(1, 2, 3));
  const Matrix3 R = poses.front().world_from_body.rotation.toRotationMatrix();
  EXPECT_NEAR(R(0, 0), 0.6, 1e-12);
  EXPECT_NEAR(R(1, 0), 0.8, 1e-12);
}

TEST(Matrices, OfZerosAreInvalidRows) {
  const std::string row = "1 0 0 1 0 1 0 2 0 0 1 3\n";
  const std::string text = row + "0 0 0 0 0 0 0 0 0 0 0 0\n" + row;
  EXPECT_THAT(why(text), HasSubstr(":2: rotation matrix is zero, expected a rotation (--drop"));
  const Trajectory poses = read_text(text, {.drop_invalid = true});
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses.back().stamp, 0.2);
}

TEST(Times, OfAListOfImages) {
  const TemporaryFolder scratch;
  const auto times =
      scratch.file("rgb.txt", "# timestamp filename\n0.5 rgb/0.5.png\n0.7 rgb/b.png\n");
  EXPECT_THAT(read_times(times, {}), ElementsAre(0.5, 0.7));
  const auto numbers = scratch.file("wrong.txt", "0.5 1.5\n");
  EXPECT_THAT(refusal([&] { read_times(numbers, {}); }),
              HasSubstr("has 2 columns, expected 1: a time in seconds, or a time and a file name"));
}

TEST(Times, OfNumbersOfFramesAndOfVertices) {
  const TemporaryFolder scratch;
  const auto times = scratch.file("times.txt", "10.0\n10.1\n10.2\n10.3\n");
  const ReadOptions options{.times = times};
  const auto frames = scratch.file(
      "frames.txt", std::string("0.0 0 0 0") + kUnit + "1.0 1 0 0" + kUnit + "3.0 2 0 0" + kUnit);
  EXPECT_THAT(stamps(read_trajectory(frames, options)), ElementsAre(10.0, 10.1, 10.3));
  EXPECT_THAT(stamps(read_trajectory(frames)), ElementsAre(0.0, 1.0, 3.0));
  EXPECT_TRUE(can_take_times(frames, Format::tum));
  EXPECT_FALSE(takes_times(frames, Format::tum));
  const auto graph = scratch.file("a.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 2 1 0 0\n");
  EXPECT_TRUE(takes_times(graph, Format::g2o));
  EXPECT_THAT(stamps(read_trajectory(graph, options)), ElementsAre(10.0, 10.2));
  EXPECT_THAT(
      refusal([&] { read_trajectory(scratch.file("b.g2o", "VERTEX_SE2 9 0 0 0\n"), options); }),
      HasSubstr("has frame 9, but"));
  const auto stamped = scratch.file("c.txt", std::string("0.5 0 0 0") + kUnit);
  EXPECT_THAT(refusal([&] { read_trajectory(stamped, options); }), HasSubstr("with stamps"));
}

TEST(Graphs, IdsThatADoubleDoesNotResolveKeepTheirOrder) {
  EXPECT_THAT(stamps(read_text("VERTEX_SE2 9007199254740992 0 0 0\n"
                               "VERTEX_SE2 9007199254740993 1 0 0\n",
                               {.period = 1.0})),
              ElementsAre(0.0, 1.0));
}

TEST(Graphs, PriorsOfDumpsAreReadAndOthersCounted) {
  EXPECT_EQ(
      read_text("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nEDGE_SE3_PRIORXYZ 0 1 2 3 1 0 0 1 0 1\n").size(),
      1u);
  EXPECT_EQ(read_text("VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\nVERTEX_PLANE 0 0 0 1 0 0.2 0.2 0.2\n"
                      "FIX 0\nEDGE_SE3_PLANE 1 0 0 0 1 0 1 0 0 1 0 1\n"
                      "EDGE_SE3_PRIORVEC 1 0 0 1 0 0 1 1 0 0 1 0 1\n"
                      "EDGE_SE3_PRIORQUAT 1 1 0 0 0 1 0 0 1 0 1\nEDGE_SE3_PRIORXY 1 2 3 1 0 1\n")
                .size(),
            1u);
}

TEST(Headers, OfPlanarPosesAreFollowed) {
  ReadFindings findings;
  const Trajectory poses =
      read_text("# timestamp x y theta\n0.5 1 2 0.5\n0.6 2 2 0.6\n", {.findings = &findings});
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 0));
  EXPECT_NEAR(2.0 * std::asin(poses[0].world_from_body.rotation.z()), 0.5, 1e-12);
  EXPECT_EQ(findings.angles, 1u);
  EXPECT_THAT(why("# timestamp x y theta\n0.5 1 2 50\n"),
              HasSubstr("theta is 50, expected radians"));
  const Trajectory degrees = read_text("t,x,y,heading [deg]\n0.5,1,2,90\n");
  EXPECT_NEAR(degrees[0].world_from_body.rotation.z(), std::sqrt(0.5), 1e-12);
}

TEST(Headers, OfEulerAnglesAreFollowed) {
  const Trajectory poses = read_text("t,x,y,z,roll,pitch,yaw\n0.5,1,2,3,0.1,0.2,0.3\n");
  const Matrix3 expected =
      (Eigen::AngleAxisd(0.3, Vector3::UnitZ()) * Eigen::AngleAxisd(0.2, Vector3::UnitY()) *
       Eigen::AngleAxisd(0.1, Vector3::UnitX()))
          .toRotationMatrix();
  EXPECT_TRUE(poses[0].world_from_body.rotation.toRotationMatrix().isApprox(expected, 1e-12));
}

TEST(Headers, OfPx4NumberTheirAxes) {
  const Trajectory poses = read_text(
      "timestamp,q[0],q[1],q[2],q[3],position[0],position[1],position[2]\n"
      "0.5,0.8,0,0,0.6,1,2,3\n");
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_EQ(poses[0].world_from_body.rotation.w(), 0.8);
}

TEST(Headers, InCommentsAreFollowedOrRejected) {
  // As LaMAR writes it: the covariance can be missing.
  const std::string header = "# timestamp, device_id, qw, qx, qy, qz, tx, ty, tz, *covar\n";
  const Trajectory poses = read_text(header + "0.5, phone, 0.8, 0, 0, 0.6, 1, 2, 3\n");
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_EQ(poses[0].world_from_body.rotation.w(), 0.8);
  EXPECT_EQ(read_text(header + "0.5, phone, 0.8, 0, 0, 0.6, 1, 2, 3, 9, 9, 9\n").size(), 1u);
  EXPECT_THAT(why("# timestamp x y bearing\n0.5 1 2 3\n", {.positions = true}),
              HasSubstr("has a header without z"));
}

}  // namespace
}  // namespace loopbench::reading_rules_test
