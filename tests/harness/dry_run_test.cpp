/// `run --dry-run` detects missing and invalid input files.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::dry_run_test {
namespace {

class DryRun : public testing::Test {
 protected:
  CommandResult run(const std::string& dataset) {
    folder_.file("c.yaml", "datasets:\n  - {" + dataset + "}\nmethods: [raw]\nmetrics: [ate]\n");
    return loopbench_command("run c.yaml --dry-run", folder_);
  }
  static std::string poses(int count) {
    std::string out;
    for (int i = 0; i < count; ++i)
      out += std::to_string(i) + " " + std::to_string(i * i) + " 0 0 0 0 0 1\n";
    return out;
  }
  TemporaryFolder folder_;
};

TEST_F(DryRun, FindsAMissingEstimate) {
  const CommandResult result = run("dataset: trajectory, label: mine, estimate: 007");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("mine: 007: no such file (looked in "), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("1 of the sequences above cannot be loaded"), std::string::npos);
  EXPECT_NE(result.out.find("0  mine / raw"), std::string::npos) << result.out;
}

TEST_F(DryRun, FindsAClosureFileThatIsNone) {
  folder_.file("e.txt", poses(20));
  folder_.file("loops.txt", "not a closure\n");
  const std::string with = "dataset: trajectory, estimate: e.txt, reference: e.txt, closures: ";
  const CommandResult result = run(with + "{source: file, file: loops.txt}");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("loops.txt:1: has 3 columns, expected 9 or 11"), std::string::npos)
      << result.err;
  EXPECT_EQ(run(with + "{source: none}").exit_code, 0);
}

TEST_F(DryRun, RejectsThreeThousandMillionCellsWithoutBuildingThem) {
  folder_.file("c.yaml",
               "datasets:\n  - {dataset: simulated, sweep: {keyframes: {from: 20, to: 1019, "
               "steps: 1000}}}\n"
               "methods: [{method: uniform, sweep: {weights: [index, time]}, label: u}, raw]\n"
               "metrics: [ate]\nrepeats: 1000000\n");
  for (const char* more : {" --dry-run", " --only nothing"}) {
    const CommandResult result = loopbench_command("run c.yaml" + std::string(more), folder_);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err,
              "loopbench: c.yaml: 1000 datasets, 3 methods and 1000000 repeats of seeded datasets "
              "give 3000000000 cells, expected at most 1000000; 'limits: {cells: N}' accepts "
              "more\n");
  }
}

TEST_F(DryRun, FindsAGraphAndAFolderOfImagesThatAreNone) {
  folder_.file("g.g2o", "VERTEX_SE2 0 0 0\n");
  EXPECT_EQ(run("dataset: pose_graph, path: g.g2o").exit_code, 2);
  std::filesystem::create_directory(folder_.path() / "images");
  const CommandResult result = run("dataset: rgbd, path: images");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err, "");
}

}  // namespace
}  // namespace loopbench::dry_run_test
