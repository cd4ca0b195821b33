#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/bags/bag_trajectory.hpp"
#include "datasets/bags/byte_reader.hpp"
#include "datasets/bags/transform_tree.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"
#include "tests/support/bag_writer.hpp"

namespace loopbench::bags_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using namespace loopbench::test;

constexpr std::int64_t kStart = 1'714'741'164'196'592'603;  // not a double
const Pose kPose{Rotation(0.5, 0.5, -0.5, 0.5), {1.25, -2.5, 0.1}};

std::vector<std::string> messages(std::size_t count, bool cdr) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto stamp = kStart + static_cast<std::int64_t>(i) * 100'000'001;
    out.push_back(cdr ? cdr_pose_stamped(stamp, kPose) : ros1_pose_stamped(stamp, kPose));
  }
  return out;
}

TEST(Bags, StampsAreReadToTheNanosecondInBothSerialisations) {
  const TemporaryFolder scratch;
  scratch.file("a.bag", ros1_bag(messages(3, false)));
  scratch.file("a.mcap", mcap(messages(3, true)));
  for (const char* const name : {"a.bag", "a.mcap"}) {
    const auto read = read_trajectory_file("bag:" + (scratch.path() / name).string() + "#/pose");
    EXPECT_EQ(read.format, Format::bag);
    EXPECT_THAT(read.nanoseconds, ElementsAre(kStart, kStart + 100'000'001, kStart + 200'000'002));
    EXPECT_EQ(read.poses[2].world_from_body.translation, kPose.translation);
    EXPECT_EQ(read.poses[2].world_from_body.rotation.coeffs(), kPose.rotation.coeffs());
  }
}

TEST(Bags, TheOnlyTopicNeedsNoName) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.bag", ros1_bag(messages(2, false)));
  EXPECT_EQ(read_trajectory(file).size(), 2u);
  EXPECT_EQ(detect_format(file), Format::bag);
  EXPECT_THAT(refusal([&] { read_trajectory("bag:" + file.string() + "#/odom"); }),
              HasSubstr("has no topic '/odom' (topics: /pose)"));
}

TEST(Bags, ATruncatedBagYieldsItsIntactPartAndStatesTheRest) {
  const TemporaryFolder scratch;
  for (const bool is_mcap : {false, true}) {
    const std::string all = is_mcap ? mcap(messages(10, true)) : ros1_bag(messages(10, false));
    const auto file = scratch.file("cut", all.substr(0, all.size() * 6 / 10));
    ReadFindings findings;
    const Trajectory poses = read_trajectory(file, {.findings = &findings});
    EXPECT_GE(poses.size(), 4u);
    EXPECT_LE(poses.size(), 6u);
    EXPECT_THAT(findings.damage, HasSubstr(" bytes are ")) << is_mcap;
  }
}

TEST(Bags, ADamagedChunkCostsOnlyItself) {
  const TemporaryFolder scratch;
  std::string bytes = ros1_bag(messages(5, false));
  bytes[bytes.rfind("conn=")] = 'X';  // in the last message's header
  ReadFindings findings;
  EXPECT_EQ(read_trajectory(scratch.file("a.bag", bytes), {.findings = &findings}).size(), 4u);
  EXPECT_EQ(findings.damage, "1 of 5 chunks are missing or damaged");
}

TEST(Bags, PosesThatAreNoneAreSkippedAndCounted) {
  const TemporaryFolder scratch;
  std::vector<std::string> all = messages(3, false);
  all.push_back(ros1_pose_stamped(kStart + 900'000'000, {Rotation(0, 0, 0, 0), {}}));
  ReadFindings findings;
  EXPECT_EQ(read_trajectory(scratch.file("a.bag", ros1_bag(all)), {.findings = &findings}).size(),
            3u);
  EXPECT_EQ(findings.damage, "1 messages without a valid pose were skipped");
}

TEST(Bags, RepeatedStampsFollowTheRuleUnlessThePosesAreEqual) {
  const TemporaryFolder scratch;
  std::vector<std::string> all = messages(2, false);
  all.push_back(all.back());
  const auto file = scratch.file("a.bag", ros1_bag(all));
  EXPECT_EQ(read_trajectory(file).size(), 2u);
  all.push_back(ros1_pose_stamped(kStart, {Rotation::Identity(), {5, 5, 5}}));
  const auto other = scratch.file("b.bag", ros1_bag(all));
  EXPECT_THAT(refusal([&] { read_trajectory(other); }), HasSubstr("has two poses"));
  EXPECT_EQ(
      read_trajectory(other, {.repeats = Repeats::keep_last})[0].world_from_body.translation.x(),
      5.0);
}

TEST(Bags, NamesAreSplitAtTheLastHash) {
  EXPECT_EQ(bag_name("bag:a#b.bag#/odom").file, "a#b.bag");
  EXPECT_EQ(bag_name("bag:a.bag#/tf:map.base").topic, "tf:map.base");
  EXPECT_EQ(to_text(bag_name("bag:a.bag#/odom")), "bag:a.bag#/odom");
  EXPECT_EQ(file_of("a#b.txt"), "a#b.txt");
}

PoseMessage transform(std::int64_t stamp, const char* parent, const char* child, double x) {
  return {stamp, parent, child, {Rotation::Identity(), {x, 0, 0}}};
}

TEST(TransformTree, InterpolatesAlongTheConnectionWhereAllAreKnown) {
  TransformTree tree;
  tree.add(transform(0, "base", "camera", 0.5), true);
  for (int i = 0; i <= 4; ++i) tree.add(transform(10 * i, "odom", "base", i), false);
  tree.add(transform(5, "map", "odom", 100.0), false);
  tree.add(transform(25, "map", "odom", 300.0), false);
  tree.finish();
  const auto poses = tree.trajectory("map", "camera");
  ASSERT_EQ(poses.size(), 2u);  // at 10 and 20, where map_from_odom is known
  EXPECT_EQ(poses[0].nanoseconds, 10);
  EXPECT_DOUBLE_EQ(poses[0].frame_from_child.translation.x(), 150.0 + 1.0 + 0.5);
  EXPECT_DOUBLE_EQ(poses[1].frame_from_child.translation.x(), 250.0 + 2.0 + 0.5);
  EXPECT_DOUBLE_EQ(tree.trajectory("camera", "odom")[0].frame_from_child.translation.x(), -0.5);
  EXPECT_THAT(
      refusal([&] { tree.trajectory("map", "lidar"); }),
      HasSubstr("no transforms connect 'map' and 'lidar' (frames: base, camera, map, odom)"));
  EXPECT_THAT(refusal([&] { tree.trajectory("base", "camera"); }), HasSubstr("is static"));
  EXPECT_THAT(refusal([&] { tree.add(transform(0, "world", "base", 0), false); }),
              HasSubstr("has two parents"));
}

class RealBags : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("LOOPBENCH_DATA") == nullptr) GTEST_SKIP() << "needs LOOPBENCH_DATA";
  }

  static std::string recording(const std::string& name) {
    return std::getenv("LOOPBENCH_DATA") + ("/bags/" + name);
  }
};

TEST_F(RealBags, FramesAreListedWhateverIsMissing) {
  const std::string file = recording("tf_example.bag");
  for (const std::string& name : {file, "bag:" + file + "#/odom", "bag:" + file + "#/tf"}) {
    EXPECT_THAT(refusal([&] { read_trajectory(name); }),
                HasSubstr("tf:PARENT.CHILD; frames: base_footprint, base_link, odom)"));
  }
}

TEST_F(RealBags, TheSameTransformsComeFromBothRosVersions) {
  const auto one =
      read_trajectory_file("bag:" + recording("tf_example.bag") + "#tf:odom.base_link");
  const auto two =
      read_trajectory_file("bag:" + recording("tf_example.db3") + "#tf:odom.base_link");
  ASSERT_GT(one.poses.size(), 100u);
  EXPECT_EQ(one.nanoseconds, two.nanoseconds);
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    ASSERT_EQ(one.poses[i].world_from_body.translation, two.poses[i].world_from_body.translation);
    ASSERT_EQ(one.poses[i].world_from_body.rotation.coeffs(),
              two.poses[i].world_from_body.rotation.coeffs());
  }
}

// Numbers of messages as stated in the index of the bag.
TEST_F(RealBags, EveryMessageOfTheRecordingsIsRead) {
  const auto read = [](const char* file, const char* topic) {
    return read_trajectory_file("bag:" + recording(file) + "#" + topic);
  };
  EXPECT_EQ(read("ROS_example.bag", "groundtruth").poses.size(), 12765u);
  EXPECT_EQ(read("ROS_example.bag", "ORB-SLAM").poses.size(), 8362u);
  const TrajectoryFile odometry = read("nav2_turtlebot.mcap", "/odom");
  EXPECT_EQ(odometry.covariances.size(), odometry.poses.size());
  EXPECT_EQ(read("nav2_turtlebot.mcap", "/amcl_pose").covariances.size(),
            read("nav2_turtlebot.mcap", "/amcl_pose").poses.size());
}

TEST_F(RealBags, CompressedDatabasesAndPipesAreRead) {
  const TemporaryFolder scratch;
  std::string database = read_all(recording("tf_example.db3"));
  database[18] = database[19] = '\2';  // has a write-ahead log, as ROS 2 bags can have
  const auto plain = scratch.file("a.db3", database);
  const auto poses_of = [](const std::filesystem::path& file) {
    return read_trajectory("bag:" + file.string() + "#tf:odom.base_link").size();
  };
  const std::size_t poses = poses_of(plain);
  EXPECT_GT(poses, 100u);
  for (const char* const program : {"gzip", "zstd -q"}) {
    const auto packed = scratch.path() / (std::string("a.db3.") + program[0]);
    const std::string command = std::string(program) + " -c '" + plain.string() + "' > '" +
                                packed.string() + "' 2>/dev/null";
    if (std::system(command.c_str()) != 0) continue;  // not installed
    EXPECT_EQ(poses_of(packed), poses) << program;
  }
  EXPECT_EQ(poses_of(Pipe(database).path()), poses);
}

TEST_F(RealBags, ATruncatedDatabaseYieldsItsIntactPart) {
  const TemporaryFolder scratch;
  const std::string all = read_all(recording("tf_example.db3"));
  const auto file = scratch.file("cut.db3", all.substr(0, all.size() / 2));
  ReadFindings findings;
  const Trajectory poses =
      read_trajectory("bag:" + file.string() + "#tf:odom.base_link", {.findings = &findings});
  EXPECT_GT(poses.size(), 50u);
  EXPECT_THAT(findings.damage, HasSubstr("stops after "));
}

}  // namespace
}  // namespace loopbench::bags_test
