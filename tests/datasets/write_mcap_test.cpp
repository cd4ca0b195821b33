#include "datasets/bags/write_mcap.hpp"

#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "datasets/formats/trajectory_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace loopbench::write_mcap_test {
namespace {

TEST(WriteMcap, ReadsBackWithEveryDigit) {
  const TemporaryFolder scratch;
  TrajectoryFile file;
  for (int i = 0; i < 3; ++i) {
    file.nanoseconds.push_back(1'700'000'000'123'456'789 + 1000 * i);
    const Rotation rotation(0.6, 0.0, 0.8 * (i == 0 ? 1 : -1), 0.0);
    file.poses.push_back({1.7e9 + 1e-6 * i, {rotation, {0.1 * i, -2.5, 1e-17}}});
  }
  const auto path = scratch.path() / "2 runs.mcap";
  write_trajectory(path, file, Format::bag);
  const TrajectoryFile read = read_trajectory_file(path);
  EXPECT_EQ(read.format, Format::bag);
  EXPECT_EQ(read.nanoseconds, file.nanoseconds);
  ASSERT_EQ(read.poses.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Pose& a = file.poses[i].world_from_body;
    const Pose& b = read.poses[i].world_from_body;
    EXPECT_EQ(a.translation, b.translation);
    EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
  }
  EXPECT_EQ(read_trajectory("bag:" + path.string() + "#/poses_2_runs").size(), 3u);
}

TEST(WriteMcap, RejectsStampsThatRosCannotRepresent) {
  const Trajectory poses{{-1.0, {}}};
  EXPECT_THROW(mcap_of(poses, {-1'000'000'000}, "/a"), InputError);
  EXPECT_THROW(mcap_of(poses, {std::int64_t{1} << 62}, "/a"), InputError);
}

}  // namespace
}  // namespace loopbench::write_mcap_test
