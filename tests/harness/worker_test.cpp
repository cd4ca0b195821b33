/// Nothing of a cell remains: state, memory, processes; limits of loading; interrupts.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/support/isolated_fixture.hpp"

namespace loopbench::worker_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using CellProcess = isolated::IsolatedFixture;

TEST_F(CellProcess, EveryCellHasAProcessOfItsOwn) {
  const std::vector<CellResult> results =
      run("datasets: [line]\n"
          "methods: [{method: mis, sweep: {deed: [own_process, abort]}},\n"
          "          {method: mis, deed: own_process, label: b}]\nmetrics: [ate]\n",
          1);
  ASSERT_EQ(results.size(), 3u);
  for (const std::size_t i : {0u, 2u}) {
    // Short runs are repeated for their time, and the first run is reported.
    EXPECT_EQ(results[i].report.counts.at(0).value, 1.0) << "something of another cell is left";
  }
}

TEST_F(CellProcess, MemoryLimitsDoNotDependOnEarlierCells) {
  std::string leaks;
  for (int i = 0; i < 5; ++i) {
    leaks += "{method: mis, deed: leak, label: l" + std::to_string(i) + "}, ";
  }
  for (const CellResult& result :
       run("datasets: [{dataset: line, sweep: {bias: [0.1, 0.2]}}]\n"
           "methods: [" +
               leaks + "straight]\nmetrics: [ate]\n" + "limits: {memory: 300MB}\n",
           1)) {
    EXPECT_EQ(result.status, Status::ok) << result.why;
  }
}

int processes_named(const std::string& name) {
  int out = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "comm");
    std::string line;
    if (std::getline(file, line) && line == name) ++out;
  }
  return out;
}

TEST_F(CellProcess, NothingOutlivesItsCell) {
  const std::vector<CellResult> results =
      run("datasets: [line]\nmethods: [{method: mis, sweep: {deed: [shell, daemon, kill]}}, "
          "shift]\nmetrics: [ate]\nlimits: {seconds: 5}\n",
          2);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].status, Status::timeout) << results[0].why;
  EXPECT_EQ(results[1].status, Status::ok) << results[1].why;
  EXPECT_EQ(results[2].signal, "SIGKILL") << results[2].why;
  EXPECT_EQ(results[3].status, Status::ok) << results[3].why;
  EXPECT_EQ(processes_named("isolate_stray"), 0);
}

TEST_F(CellProcess, ASequenceThatExceedsALimitIsNotLoadedForEachOfItsCells) {
  void* memory = mmap(
      nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto& loads = *new (memory) std::atomic<int>(0);
  known_.datasets.push_back(dataset<tiny::LineOptions>(
      "slow", "", [&](const tiny::LineOptions&, const DataRoot&) -> Sequence {
        ++loads;
        for (;;) pause();
      }));
  const std::vector<CellResult> results =
      run("datasets: [slow, line]\nmethods: [straight, {method: shift, sweep: {by: [1, 2, 3]}}]\n"
          "metrics: [ate]\nlimits: {seconds: 4.5}\n",
          2);
  ASSERT_EQ(results.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(results[i].status, i < 4 ? Status::timeout : Status::ok) << results[i].why;
    EXPECT_EQ(results[i].why, i < 4 ? "loading its sequence exceeded the time limit of 4.5 s" : "");
  }
  EXPECT_EQ(loads, 1);
  munmap(memory, sizeof(std::atomic<int>));
}

StopRequests interrupts = 0;

TEST_F(CellProcess, ASecondInterruptAbandonsRunningCells) {
  const Sweep sweep = parse_sweep(
      "datasets: [line]\nmethods: [straight, {method: mis, deed: hang}, shift]\nmetrics: [ate]\n",
      "c.yaml",
      known_);
  std::signal(SIGALRM, [](int) { interrupts = 2; });
  std::vector<CellResult> results;
  const auto finished = [&](const CellResult& result) {
    results.push_back(result);
    if (results.size() == 1) ualarm(500000, 0);  // the second cell never ends
  };
  const std::vector<Cell> planned = cells(sweep, seeded(sweep, known_), "");
  run_isolated(sweep, planned, known_, {}, 1, sandbox_, interrupts, finished);
  std::signal(SIGALRM, SIG_DFL);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[1].status, Status::interrupted) << results[1].why;
  EXPECT_FALSE(is_failure(results[1].status));
}

}  // namespace
}  // namespace loopbench::worker_test
