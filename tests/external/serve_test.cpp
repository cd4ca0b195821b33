// Programs that stay running: one process answers the cells of a worker, and is started again after
// a failure, which costs one cell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include "harness/catalogue/server.hpp"
#include "harness/store/read.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::serve_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using testing::HasSubstr;

struct Misbehaviour {
  std::string mode;
  std::string status;
  std::string why;
};

class Serve : public testing::TestWithParam<Misbehaviour> {};

TEST_P(Serve, AMisbehavingProgramCostsOneCell) {
  const TemporaryFolder folder;
  const Misbehaviour& each = GetParam();
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, path: room, keyframes: 30}]\nmethods:\n"
              "  - {method: command, serve: '" LOOPBENCH_SERVING " " +
                  each.mode + "'}\nmetrics: [ate]\nrepeats: 3\nlimits: {memory: 700MiB, seconds: " +
                  (each.mode == "hang" ? "8" : "100") + "}\n");
  const CommandResult ran = loopbench_command("run c.yaml --out r -j 1", folder);
  const std::vector<CellRow> cells = read_cells(folder.path() / "r");
  ASSERT_EQ(cells.size(), 3u) << ran.err;
  EXPECT_EQ(to_text(cells[1].status), each.status) << cells[1].why;
  EXPECT_THAT(cells[1].why.text(), HasSubstr(each.why));
  EXPECT_LT(cells[1].why.text().size(), 2200u) << "output is cut off";
  EXPECT_EQ(cells[0].status, Status::ok) << cells[0].why;
  EXPECT_EQ(cells[2].status, Status::ok) << cells[2].why;
}

INSTANTIATE_TEST_SUITE_P(
    All,
    Serve,
    testing::Values(Misbehaviour{"ok", "ok", ""},
                    Misbehaviour{"crash", "failed", "was ended by SIGABRT before its answer"},
                    Misbehaviour{"exit", "failed", "exited with code 3"},
                    Misbehaviour{"hang", "timeout", "exceeded the time limit"},
                    Misbehaviour{"flood", "failed", "exited with code 4"},
                    Misbehaviour{"grow", "out_of_memory", "grew to"},
                    Misbehaviour{"print", "failed", "something else than an answer"},
                    Misbehaviour{"number", "failed", "answered request 3, expected 2"},
                    Misbehaviour{"counts", "failed", "has 29 poses, expected 30"},
                    Misbehaviour{"nan", "failed", "is not finite"},
                    Misbehaviour{"stamps", "failed", "has stamp"},
                    Misbehaviour{"declined", "declined", "no mood"},
                    Misbehaviour{"json", "failed", "result.json: "},
                    Misbehaviour{"half", "failed", "exited with code 0 before its answer"}),
    [](const auto& chosen) { return chosen.param.mode; });

/// Cells of one sequence and two repeats, answered by the serving program.
std::vector<CellRow> served(const std::string& mode, const std::string& settings = "") {
  const TemporaryFolder folder;
  folder.file("c.yaml",
              "datasets: [{dataset: simulated, path: room, keyframes: 30}]\nmethods:\n"
              "  - {method: command, serve: '" LOOPBENCH_SERVING " " +
                  mode + "'}\nmetrics: [ate]\nrepeats: 2\n" + settings);
  const CommandResult ran = loopbench_command("run c.yaml --out r -j 1", folder);
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  return read_cells(folder.path() / "r");
}

double value_of(const CellRow& cell, const std::string& count) {
  const auto found = std::ranges::find(cell.counts, count, &Count::name);
  return found == cell.counts.end() ? -1.0 : found->value;
}

TEST(ServedTime, StartIsNotPartOfTheFirstCell) {
  const std::vector<CellRow> cells = served("late");
  ASSERT_EQ(cells.size(), 2u);
  ASSERT_EQ(cells[0].phases.front().name, kExchangePhase);
  EXPECT_GE(cells[0].phases.front().seconds, 0.3) << "of 0.4 s; it started a little earlier";
  EXPECT_THAT(cells[0].worker.text(), HasSubstr("serial")) << "-j 1: no other cell ran";
}

TEST(ServedTime, EveryTimedRunAsksANewProcess) {
  const std::vector<CellRow> cells = served("turns", "timing: 3\n");
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(value_of(cells[0], "turn"), 1.0) << "a second answer could be from its memory";
  EXPECT_GT(value_of(cells[1], kProgramMemory), 1e5) << "a process has more than 100 kB";
  EXPECT_EQ(cells[1].peak_memory, static_cast<std::int64_t>(value_of(cells[1], kProgramMemory)));
  EXPECT_GE(value_of(cells[1], kProgramTime), 0.0);
}

TEST(ServedTime, IsTheWallTimeWhateverTheProgramStates) {
  const std::vector<CellRow> cells = served("ok");  // states 0 s
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_GT(cells[1].seconds, 0.0);
  EXPECT_EQ(cells[1].worker, "isolated, serial");
}

/// Asks from a forked process, as the cells of a worker do; returns whether the answer is right.
bool asks_in_a_child(const CommandOptions& options, const Problem& problem, bool dies = false) {
  const pid_t child = fork();
  if (child == 0) {
    Report report;
    if (dies) {
      alarm(1);  // the program hangs, and the cell is killed
    }
    try {
      const Trajectory out = ask_server(options, {}, problem, report);
      _exit(out.size() == problem.keyframes.size() ? 0 : 1);
    } catch (const std::exception&) {
      _exit(2);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(Server, AnswersForkedProcessesAndRecoversFromTheirEnd) {
  CommandOptions options;
  options.serve = LOOPBENCH_SERVING " hang";
  const Problem problem = test::circle(30);
  prepare_server(options, {});
  EXPECT_TRUE(asks_in_a_child(options, problem));
  prepare_server(options, {});
  EXPECT_FALSE(asks_in_a_child(options, problem, true)) << "the second request hangs";
  prepare_server(options, {});  // starts it again
  EXPECT_TRUE(asks_in_a_child(options, problem));
}

}  // namespace
}  // namespace loopbench::serve_test
