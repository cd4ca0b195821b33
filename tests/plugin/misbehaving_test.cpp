/// Plugins whose code must not run in the sweep or change cells of others.
#include <gtest/gtest.h>

#include <cstdlib>

#include "harness/sweep/catalogue/catalogue.hpp"
#include "harness/sweep/catalogue/plugins.hpp"
#include "harness/sweep/store/read.hpp"
#include "tests/support/command.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

struct Ran {
  CommandResult command;
  std::vector<CellRow> cells;
  std::vector<Record> records;
};

/// Runs a sweep of one simulated sequence with these lines of a config and the plugin.
Ran run_with(const std::string& lines, const std::string& plugin = LOOPBENCH_MISBEHAVING) {
  const TemporaryFolder folder;
  folder.file("c.yaml", "datasets: [{dataset: simulated, path: room, keyframes: 40}]\n" + lines);
  Ran out{loopbench_command("run c.yaml --out r --plugin '" + plugin + "'", folder), {}, {}};
  if (out.command.exit_code < 2) {
    out.cells = read_cells(folder.path() / "r");
    out.records = read_records(folder.path() / "r");
  }
  return out;
}

TEST(Misbehaving, ItsCodeDoesNotRunInTheSweep) {
  const CommandResult loaded =
      run_with("methods: [raw]\nmetrics: [ate]", LOOPBENCH_EXITS_WHEN_LOADED).command;
  EXPECT_EQ(loaded.exit_code, 2);
  EXPECT_NE(loaded.err.find("exits_when_loaded.so: a process that loaded it exited with code 0"),
            std::string::npos)
      << loaded.err;
  // Its constructor hangs: in the check of its options for 10 s, and in its cell.
  const auto [made, cells, records] =
      run_with("methods: [raw, hangs_when_made]\nmetrics: [ate]\nlimits: {seconds: 1}");
  ASSERT_EQ(cells.size(), 2u) << made.err;
  EXPECT_EQ(cells[0].status, Status::ok);
  EXPECT_EQ(cells[1].status, Status::timeout) << cells[1].why;
}

TEST(Misbehaving, AConstructorThatThrowsCostsItsOwnCells) {
  const auto [ran, cells, records] = run_with("metrics: [ate]\nmethods: [raw, throws_when_made]");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].status, Status::ok);
  EXPECT_EQ(cells[1].status, Status::failed);
  EXPECT_EQ(cells[1].why, "plugin misbehaving.so: method 'throws_when_made': no licence");
}

TEST(Misbehaving, AFileInMemoryCountsAsMemory) {
  const std::vector<CellRow> cells =
      run_with("metrics: [ate]\nmethods: [fills_memory_file]\nlimits: {memory: 256MiB}").cells;
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0].status, Status::out_of_memory) << cells[0].why;
}

TEST(Misbehaving, LoadingEndsAtItsLimit) {
  setenv("LOOPBENCH_TEST_LOOPS", "1", 1);
  EXPECT_NE(refusal_of<InputError>([] {
              describe_plugin(LOOPBENCH_EXITS_WHEN_LOADED, 0.3);
            }).find("a process that loaded it took longer than 0.3 s"),
            std::string::npos);
  unsetenv("LOOPBENCH_TEST_LOOPS");
}

/// Expects that all cells of a sweep with these methods of the plugin are ok.
void expect_all_ok(const std::string& plugin, const std::string& methods, int seconds) {
  const auto [result, cells, records] =
      run_with("repeats: 3\nmetrics: [ate]\nmethods: [" + methods +
                   "]\nlimits: {seconds: " + std::to_string(seconds) + "}",
               plugin);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  for (const CellRow& cell : cells) {
    EXPECT_EQ(cell.status, Status::ok) << cell.method << ": " << cell.why;
  }
}

TEST(Misbehaving, ThreadsOfAPluginRunInItsCells) {
  expect_all_ok(LOOPBENCH_MISBEHAVING, "pooled, raw, {method: pooled, label: b}", 20);
}

#ifdef LOOPBENCH_OPENMP_PLUGIN
TEST(Misbehaving, APluginWithOpenMPHangsNoCell) {
  expect_all_ok(LOOPBENCH_OPENMP_PLUGIN,
                "in_parallel, pose_graph_huber, {method: in_parallel, label: b}",
                100);
}
#endif

TEST(Misbehaving, AMetricDoesNotChangeWhatOthersRead) {
  const auto ate = [](const std::string& before) {
    const std::vector<Record> records =
        run_with("methods: [raw]\nmetrics: [" + before + "ate]").records;
    return records.empty() ? 0.0 : records.back().statistics.rmse;
  };
  const double expected = ate("");
  EXPECT_GT(expected, 0.0);
  EXPECT_EQ(ate("moves_estimate, "), expected);
  EXPECT_EQ(ate("rounds_upward, "), expected);
}

TEST(Misbehaving, ItsVersionCoversTheLibrariesThatItBrings) {
  const Catalogue known = catalogue({LOOPBENCH_MISBEHAVING});
  const std::vector<std::filesystem::path> brought =
      describe_plugin(LOOPBENCH_MISBEHAVING).libraries;
  ASSERT_EQ(brought.size(), 1u);
  EXPECT_EQ(brought[0].filename(), "libcompanion.so");
  EXPECT_NE(known.versions.at("method exits").find(", libcompanion.so "), std::string::npos);
}

}  // namespace
}  // namespace loopbench
