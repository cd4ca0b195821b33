/// TUM, KITTI and EuRoC files.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::text_formats_test {
namespace {

/// Poses with extreme double values.
Trajectory wild_trajectory(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-30, 30);
  Trajectory out;
  double stamp = 1305031910.765238;
  for (std::size_t i = 0; i < count; ++i) {
    stamp += 0.03 + 0.01 * uniform(random);
    const auto wild = [&] { return std::ldexp(uniform(random), exponent(random)); };
    const Rotation q(uniform(random), uniform(random), uniform(random), uniform(random));
    out.push_back({stamp, {q.normalized(), {wild(), wild(), wild()}}});
  }
  return out;
}

TEST(Tum, ReadsStampPositionQuaternion) {
  const Trajectory poses = read_trajectory(sample("good/tum.txt"));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[0].stamp, 1.5);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_EQ(poses[1].world_from_body.translation, Vector3(4, 5, -6));
  EXPECT_TRUE((poses[1].world_from_body.rotation * Vector3::UnitX()).isApprox(Vector3::UnitY()));
}

TEST(Tum, NormalisesWhatPrintedDigitsLeave) {
  const Trajectory poses = read_trajectory(sample("good/tum.txt"));
  EXPECT_EQ(poses[2].world_from_body.rotation.w(), 1.0);
  check(poses, "good");
}

TEST(Tum, WritingAndReadingKeepsEveryBit) {
  const TemporaryFolder scratch;
  const Trajectory poses = wild_trajectory(2000);
  write_tum(scratch.path() / "a.txt", poses);
  EXPECT_TRUE(same_bits(read_trajectory(scratch.path() / "a.txt"), poses));
}

TEST(Tum, StampsHaveNoExponent) {
  const TemporaryFolder scratch;
  write_tum(scratch.path() / "a.txt", Trajectory{{1.7e9, {}}, {1.7e9 + 0.5, {}}});
  EXPECT_EQ(read_all(scratch.path() / "a.txt"),
            "1700000000 0 0 0 0 0 0 1\n1700000000.5 0 0 0 0 0 0 1\n");
}

TEST(Tum, CommentsStandOnTopAndAreSkipped) {
  const TemporaryFolder scratch;
  const Trajectory poses{{0.5, {}}};
  write_tum(scratch.path() / "a.txt", poses, {"method: raw", "two\nlines"});
  EXPECT_EQ(read_all(scratch.path() / "a.txt"),
            "# method: raw\n# two\n# lines\n0.5 0 0 0 0 0 0 1\n");
  EXPECT_TRUE(same_bits(read_trajectory(scratch.path() / "a.txt"), poses));
}

TEST(Tum, WindowsLineEndsAndByteOrderMarkChangeNothing) {
  const TemporaryFolder scratch;
  const std::string lf = read_all(sample("good/tum.txt"));
  std::string crlf;
  for (const char c : lf) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const Trajectory plain = read_trajectory(sample("good/tum.txt"));
  EXPECT_TRUE(same_bits(read_trajectory(scratch.file("crlf.txt", crlf)), plain));
  EXPECT_TRUE(same_bits(read_trajectory(scratch.file("bom.txt", "\xEF\xBB\xBF" + lf)), plain));
  const std::string bare = lf.substr(0, lf.size() - 1);
  EXPECT_TRUE(same_bits(read_trajectory(scratch.file("no_newline.txt", bare)), plain));
}

TEST(Tum, RepeatedStampsCanBeDroppedWhenAsked) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.txt", "1 0 0 0 0 0 0 1\n1 9 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n");
  ReadOptions options;
  options.repeats = Repeats::keep_first;
  const Trajectory poses = read_trajectory(file, options);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].world_from_body.translation.x(), 0.0);
  EXPECT_EQ(poses[1].world_from_body.translation.x(), 5.0);
  options.repeats = Repeats::keep_last;  // like the reader of TUM
  const Trajectory last = read_trajectory(file, options);
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last[0].stamp, 1.0);
  EXPECT_EQ(last[0].world_from_body.translation.x(), 9.0);
}

TEST(Euroc, StampsOfASimulatorAreNanosecondsToo) {
  const TemporaryFolder scratch;
  // Starts at 0, 20 Hz, with qw first.
  const auto csv = scratch.file("a.csv",
                                "#timestamp,px,py,pz,qw,qx,qy,qz\n"
                                "0,1,2,3,0.8,0,0,0.6\n50000000,4,5,6,0.8,0,0,0.6\n");
  EXPECT_EQ(detect_format(csv), Format::euroc);
  const Trajectory poses = read_trajectory(csv);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].stamp, 0.05);
  EXPECT_EQ(poses[1].world_from_body.rotation.w(), 0.8);
  const auto wide = scratch.file("b.csv",
                                 "1000000000,1,2,3,0.8,0,0,0.6,0,0,0\n"
                                 "1005000000,4,5,6,0.8,0,0,0.6,0,0,0\n");
  EXPECT_EQ(read_trajectory(wide)[1].stamp, 1.005);
  const auto blanks = scratch.file("c.txt", "0 1 2 3 0 0 0.6 0.8\n50000000 4 5 6 0 0 0.6 0.8\n");
  EXPECT_EQ(read_trajectory(blanks)[1].stamp, 0.05);
  EXPECT_EQ(read_trajectory(blanks)[1].world_from_body.rotation.w(), 0.8);
  // Format of ORB-SLAM3.
  const auto zeros =
      scratch.file("d.txt", "0.000000 1 2 3 0 0 0.6 0.8\n50000000.000000 4 5 6 0 0 0.6 0.8\n");
  EXPECT_EQ(read_trajectory(zeros)[1].stamp, 0.05);
}

TEST(Tum, GoingBackIsRefusedEvenWhenRepeatsAreDropped) {
  const TemporaryFolder scratch;
  const auto file = scratch.file("a.txt", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n");
  EXPECT_EQ(refusal([&] { read_trajectory(file, {.repeats = Repeats::keep_first}); }),
            file.string() +
                ":3: stamp 0.0 is smaller than stamp 1.0 on line 1, expected increasing "
                "stamps (--sort, or sort: true in a config)");
}

TEST(Tum, BrokenTrajectoriesAndPathsAreNotWritten) {
  const TemporaryFolder scratch;
  const auto file = scratch.path() / "a.txt";
  EXPECT_EQ(refusal([&] {
              write_tum(file, {{1.0, {}}, {1.0, {}}});
            }),
            file.string() + ": pose 1: stamp does not increase");
  EXPECT_FALSE(std::filesystem::exists(file));
  const auto nowhere = scratch.path() / "no/such/folder.txt";
  EXPECT_EQ(refusal([&] { write_tum(nowhere, {}); }),
            nowhere.string() + ": cannot be written: No such file or directory");
}

TEST(Tum, IsRecognisedByContent) {
  EXPECT_EQ(detect_format(sample("good/tum.txt")), Format::tum);
  EXPECT_EQ(detect_format(sample("good/kitti.txt")), Format::kitti);
  EXPECT_EQ(detect_format(sample("good/euroc.csv")), Format::euroc);
  EXPECT_EQ(detect_format(sample("good/se2.g2o")), Format::g2o);
  EXPECT_EQ(detect_format(sample("good/toro.txt")), Format::g2o);
}

TEST(Kitti, ReadsRowsAsMatrices) {
  const Trajectory poses = read_trajectory(sample("good/kitti.txt"));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_EQ(poses[1].world_from_body.translation, Vector3(4, 5, 6));
  EXPECT_TRUE((poses[1].world_from_body.rotation * Vector3::UnitX()).isApprox(Vector3::UnitY()));
  check(poses, "good");
}

TEST(Kitti, StampsAreAPeriodApartOrFromTheTimesFile) {
  const auto file = sample("good/kitti.txt");
  EXPECT_EQ(read_trajectory(file)[2].stamp, 2 * 0.1);
  ReadOptions options;
  options.period = 0.5;
  EXPECT_EQ(stamps(read_trajectory(file, options)), (std::vector{0.0, 0.5, 1.0}));
  options.times = sample("good/kitti_times.txt");
  EXPECT_EQ(stamps(read_trajectory(file, options)), (std::vector{0.0, 0.104, 0.207}));
}

TEST(Kitti, WritingAndReadingKeepsPosesToRounding) {
  const TemporaryFolder scratch;
  const Trajectory poses = wild_trajectory(1000);
  write_trajectory(
      scratch.path() / "poses.txt", {poses}, Format::kitti, scratch.path() / "times.txt");
  const Trajectory back =
      read_trajectory(scratch.path() / "poses.txt", {.times = scratch.path() / "times.txt"});
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(back[i].stamp, poses[i].stamp);
    EXPECT_TRUE(is_close(back[i].world_from_body, poses[i].world_from_body, 0.0, 1e-14)) << i;
  }
}

TEST(Euroc, ReadsNanosecondsAndQuaternionWithWFirst) {
  const Trajectory poses = read_trajectory(sample("good/euroc.csv"));
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].stamp, 1403715524.907143168);
  EXPECT_EQ(poses[1].stamp, 1403715524.912143104);
  EXPECT_EQ(poses[0].world_from_body.translation, Vector3(1, 2, 3));
  EXPECT_TRUE((poses[1].world_from_body.rotation * Vector3::UnitX()).isApprox(Vector3::UnitY()));
}

}  // namespace
}  // namespace loopbench::text_formats_test
