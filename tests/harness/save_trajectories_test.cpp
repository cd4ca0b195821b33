// `run --save-trajectories` and `export`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/formats/formats.hpp"
#include "harness/store/read.hpp"
#include "tests/support/command.hpp"

namespace loopbench::save_test {

using namespace harness;

namespace {

using testing::HasSubstr;

TEST(SaveTrajectories, EveryCellsEstimateIsKeptAtFullLength) {
  const TemporaryFolder folder;
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, label: a, path: room, keyframes: 40}]\n"
              "methods: [raw, uniform + cubic_spline]\nmetrics: [ate]\nrepeats: 2\n");
  const CommandResult ran = loopbench_command("run c.yaml --out r --save-trajectories", folder);
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const CommandResult done = loopbench_command("export r --what trajectories -o out", folder);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("8 files with references and index.csv in out"));
  std::size_t keyframes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "out")) {
    if (entry.path().extension() == ".csv") continue;
    const Trajectory poses = read_trajectory(entry.path());
    if (entry.path().filename().string().find("keyframes") == std::string::npos) continue;
    ++keyframes;
    EXPECT_EQ(poses.size(), 40u);
    EXPECT_THAT(read_all(entry.path()), HasSubstr("# method: "));
  }
  EXPECT_EQ(keyframes, 4u);
}

TEST(Export, WithoutSavedTrajectoriesItNamesTheOption) {
  const TemporaryFolder folder;
  folder.file("c.yaml", "datasets: [{dataset: simulated}]\nmethods: [raw]\nmetrics: [ate]\n");
  loopbench_command("run c.yaml --out r", folder);
  const CommandResult done = loopbench_command("export r --what trajectories -o out", folder);
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("--save-trajectories"));
  const CommandResult rows = loopbench_command("export r", folder);
  EXPECT_EQ(rows.exit_code, 0) << rows.err;
  EXPECT_THAT(rows.out, HasSubstr("ate"));
}

}  // namespace
}  // namespace loopbench::save_test
