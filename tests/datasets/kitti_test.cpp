#include <gtest/gtest.h>

#include <random>

#include "datasets/formats/trajectory_file.hpp"
#include "tests/datasets/scratch.hpp"

namespace loopbench::kitti_test {
namespace {

Trajectory random_trajectory(std::size_t count) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Trajectory out;
  for (std::size_t i = 0; i < count; ++i) {
    const Rotation q(normal(random), normal(random), normal(random), normal(random));
    out.push_back({0.1 * static_cast<double>(i),
                   {q.normalized(), {normal(random), 100.0 * normal(random), normal(random)}}});
  }
  return out;
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
  const Trajectory poses = random_trajectory(1000);
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
}  // namespace loopbench::kitti_test
