// Programs as SLAM systems: dataset `command`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "datasets/formats/formats.hpp"
#include "harness/base/sandbox.hpp"
#include "harness/store/read.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::command_dataset_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using testing::HasSubstr;

/// A recording (a file) that a shell script copies as its open trajectory, with one loop.
class CommandDataset : public testing::Test {
 protected:
  CommandDataset() {
    setenv("LOOPBENCH_CACHE", (folder_.path() / "cache").c_str(), 1);
    const Problem problem = test::circle(41);
    write_tum(folder_.path() / "recording.txt", problem.keyframes);
    folder_.file("slam.sh",
                 "echo run $3 >>runs\ncp $1 $2\ncp $1 $2.closed\n"
                 "echo '0 20 0 0 0 0 0 0 1 0.02 0.01' >$2.loops\n");
  }
  ~CommandDataset() override { unsetenv("LOOPBENCH_CACHE"); }

  CommandResult run(const std::string& more, const std::string& settings = "") {
    folder_.file("c.yaml",
                 "datasets:\n  - {dataset: command, label: mine, sequence: recording.txt, "
                 "reference: recording.txt, " +
                     more + "}\nmethods: [raw, uniform]\nmetrics: [ate]\ntimes: keyframes\n" +
                     settings);
    return loopbench_command("run c.yaml --fresh --no-sandbox --out r", folder_);
  }

  std::size_t runs() const {
    const std::string text = read_all(folder_.path() / "runs");
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  const std::string program_ = "run: 'sh slam.sh {sequence} {trajectory} {seed}'";
  TemporaryFolder folder_;
};

TEST_F(CommandDataset, ItsOutputIsCorrectedAndCached) {
  const CommandResult done = run(program_);
  ASSERT_EQ(done.exit_code, 0) << done.err << done.out;
  EXPECT_EQ(runs(), 1u);
  for (const CellRow& cell : read_cells(folder_.path() / "r")) {
    EXPECT_EQ(cell.status, Status::ok) << cell.why;
    EXPECT_EQ(cell.closures, "of the program");
    EXPECT_EQ(cell.closure_count, 1);
  }
  run(program_);
  EXPECT_EQ(runs(), 1u) << "the output is cached";
  folder_.file("recording.txt", read_all(folder_.path() / "recording.txt") + "\n");
  run(program_);
  EXPECT_EQ(runs(), 2u) << "the recording changed";
  folder_.file("slam.sh", read_all(folder_.path() / "slam.sh") + "\n");
  run(program_);
  EXPECT_EQ(runs(), 3u) << "the program changed";
  for (const auto& each : std::filesystem::recursive_directory_iterator(folder_.path() / "cache")) {
    if (each.path().filename() == "open.txt") std::ofstream(each.path(), std::ios::app) << "\n";
  }
  run(program_);
  EXPECT_EQ(runs(), 4u) << "the cached output changed";
}

TEST_F(CommandDataset, ItsEdgesAreThoseOfAGraph) {
  folder_.file("graph.sh",
               "{ for i in 0 1 2 3; do echo VERTEX_SE2 $i $i 0 0; done\n"
               "for i in 0 1 2; do echo EDGE_SE2 $i $((i + 1)) 1 0 0 500 0 0 500 0 40000; done\n"
               "echo EDGE_SE2 0 3 2.5 0 0 200 0 0 200 0 9000; } >$2\n");
  folder_.file("c.yaml",
               "datasets:\n  - {dataset: command, run: 'sh graph.sh none {trajectory}'}\n"
               "methods:\n  - {method: command, run: 'cp {problem}/graph.g2o kept.g2o && cp "
               "{problem}/keyframes.txt {result}', shell: true}\n"
               "metrics: [graph_cost]\ntimes: keyframes\n");
  const CommandResult done = loopbench_command("run c.yaml --no-sandbox --out r", folder_);
  ASSERT_EQ(done.exit_code, 0) << done.err << done.out;
  const std::string graph = read_all(folder_.path() / "kept.g2o");
  EXPECT_THAT(graph, HasSubstr("EDGE_SE2 0 1 1 0 0 500 0 0 500 0 40000"));
  EXPECT_THAT(graph, HasSubstr("EDGE_SE2 0 3 2.5 0 0 200 0 0 200 0 9000"));
}

TEST_F(CommandDataset, ItsCostIsKeptAndHeldToTheLimits) {
  folder_.file("slam.sh",
               "echo run >>runs\ndd bs=60M count=1 if=/dev/zero of=/dev/null\ncp $1 $2\n");
  const std::string notes = run(program_).err;
  EXPECT_THAT(notes, HasSubstr("mine: the program took "));
  EXPECT_THAT(notes, HasSubstr("real-time factor"));
  run("memory: 40, " + program_);
  EXPECT_THAT(read_cells(folder_.path() / "r")[0].why, HasSubstr("MiB, the limit is 40 MiB"));
  EXPECT_EQ(runs(), 1u);  // what was kept is checked
}

TEST_F(CommandDataset, AnotherVersionRunsAgain) {
  run("version: a, " + program_);
  run("version: a, " + program_);
  EXPECT_EQ(runs(), 1u);
  run("version: b, " + program_);
  EXPECT_EQ(runs(), 2u);
}

TEST_F(CommandDataset, RepeatsAreRunsOfTheProgram) {
  const CommandResult done = run(program_, "repeats: 3\n");
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(runs(), 3u);
  EXPECT_EQ(read_cells(folder_.path() / "r").size(), 6u);
}

TEST_F(CommandDataset, ItsClosedTrajectoryIsEvaluatedAsItIs) {
  const CommandResult done = run(program_ + ", use: closed");
  const std::vector<CellRow> cells = read_cells(folder_.path() / "r");
  ASSERT_EQ(cells.size(), 2u) << done.err;
  EXPECT_EQ(cells[0].status, Status::ok);
  EXPECT_EQ(cells[1].status, Status::declined) << "no closures are left";
}

TEST_F(CommandDataset, ItsProgramCannotReadTheReferenceOrWriteElsewhere) {
  if (!has_bubblewrap()) GTEST_SKIP() << "no bubblewrap";
  folder_.file("reference.txt", read_all(folder_.path() / "recording.txt"));
  folder_.file("curious.sh",
               "cat reference.txt && exit 9\necho x >outside && exit 8\n"
               "echo x >$TMPDIR/inside && cp $1 $2\n");
  folder_.file("c.yaml",
               "datasets:\n  - {dataset: command, sequence: recording.txt, reference: "
               "reference.txt, run: 'sh curious.sh {sequence} {trajectory}'}\n"
               "methods: [raw]\nmetrics: [ate]\ntimes: keyframes\n");
  const CommandResult done = loopbench_command("run c.yaml --out r", folder_);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  folder_.file("curious.sh", read_all(folder_.path() / "curious.sh") + "\n");
  EXPECT_EQ(loopbench_command("run c.yaml --no-sandbox --out r", folder_).exit_code, 1);
  EXPECT_THAT(read_cells(folder_.path() / "r").at(0).why.text(), HasSubstr("exited with code 9"));
}

TEST_F(CommandDataset, FailuresCostItsOwnCellsAndHaveTheOutput) {
  folder_.file("c.yaml",
               "datasets:\n"
               "  - {dataset: command, label: exits, sequence: recording.txt, reference: "
               "recording.txt, run: 'sh -c \"echo no camera; exit 7\" {trajectory}'}\n"
               "  - {dataset: command, label: writes nothing, sequence: recording.txt, reference: "
               "recording.txt, run: 'true {trajectory}'}\n"
               "  - {dataset: simulated, keyframes: 20, label: other}\n"
               "methods: [raw, uniform]\nmetrics: [ate]\ntimes: keyframes\n");
  EXPECT_EQ(loopbench_command("run c.yaml --out r", folder_).exit_code, 1);
  const std::vector<CellRow> cells = read_cells(folder_.path() / "r");
  ASSERT_EQ(cells.size(), 6u);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(cells[i].status, Status::failed);
    EXPECT_THAT(cells[i].why.text(), HasSubstr("dataset 'exits': "));
    EXPECT_THAT(cells[i].why.text(), HasSubstr("its output ends with: no camera"));
  }
  EXPECT_THAT(cells[2].why.text(), HasSubstr("dataset 'writes nothing': "));
  EXPECT_THAT(cells[2].why.text(), HasSubstr("wrote no trajectory"));
  EXPECT_EQ(cells[4].status, Status::ok);
  EXPECT_EQ(cells[5].status, Status::ok);
}

TEST_F(CommandDataset, MistakesAreReported) {
  EXPECT_THAT(run("run: 'true {sequence}'").err, HasSubstr("does not contain {trajectory}"));
  EXPECT_THAT(run("estimate: a.txt, " + program_).err, HasSubstr("estimate: unknown option"));
}

}  // namespace
}  // namespace loopbench::command_dataset_test
