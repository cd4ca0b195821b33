/// Shards through the command line: run, merge, complete.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/command.hpp"
#include "tests/support/store_text.hpp"

namespace loopbench::shard_cli_test {

namespace {

class ShardCli : public testing::Test {
 protected:
  ShardCli() {
    std::ofstream(folder_.path() / "c.yaml")
        << "datasets: [{dataset: simulated, path: room, keyframes: 20, label: a},\n"
           "           {dataset: simulated, path: office, keyframes: 20, label: 'b;$(x) c'}]\n"
           "methods: [raw, uniform]\nmetrics: [ate]\nrepeats: 3\ntimes: keyframes\n";
  }
  CommandResult run(const std::string& arguments) { return loopbench_command(arguments, folder_); }
  std::filesystem::path at(const std::string& name) { return folder_.path() / name; }

  TemporaryFolder folder_;
};

TEST_F(ShardCli, ShardsMergeToTheUndisturbedSweep) {
  ASSERT_EQ(run("run c.yaml --out whole").exit_code, 0);
  ASSERT_EQ(run("run c.yaml --out o --shard 1/2").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(at("o/table.md"))) << "only of the merged store";
  const CommandResult half = run("merge o/shards/* -o o");
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_NE(half.out.find("6 of 12 cells are missing; shards without a cell: 2/2"),
            std::string::npos)
      << half.out;
  const CommandResult rest = run("run c.yaml --out o");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.out.find("12 of 12 cells done (6 of them in earlier runs)"), std::string::npos)
      << rest.out;
  EXPECT_EQ(store_text(at("o")), store_text(at("whole")));
  ASSERT_EQ(run("run c.yaml --out o --shard 2/2").exit_code, 0);
  ASSERT_EQ(run("merge --add o/shards/2-of-2 -o o").exit_code, 0);
  EXPECT_EQ(store_text(at("o")), store_text(at("whole"))) << "cells that are there already";
}

TEST_F(ShardCli, ShardsOfDifferentConfigsAreRejected) {
  ASSERT_EQ(run("run c.yaml --out o --shard 1/2").exit_code, 0);
  std::ofstream(at("d.yaml"))
      << "datasets: [{dataset: simulated, path: room, keyframes: 30, label: a},\n"
         "           {dataset: simulated, path: office, keyframes: 30, label: b}]\n"
         "methods: [raw, uniform]\nmetrics: [ate]\nrepeats: 3\ntimes: keyframes\n";
  ASSERT_EQ(run("run d.yaml --out o --shard 2/2").exit_code, 0);
  const CommandResult merged = run("merge o/shards/1-of-2 o/shards/2-of-2 -o all");
  EXPECT_EQ(merged.exit_code, 2) << merged.out;
  EXPECT_NE(merged.err.find("2-of-2/results.sqlite: is a shard of a different config"),
            std::string::npos)
      << merged.err;
  EXPECT_FALSE(std::filesystem::exists(at("all/results.sqlite")));
}

TEST_F(ShardCli, FailedCellsCanBeResults) {
  std::ofstream(at("f.yaml"))
      << "datasets: [{dataset: simulated, path: room, keyframes: 20}]\n"
         "methods: [raw, {method: command, label: fails, run: 'false {problem} {result}'}]\n"
         "metrics: [ate]\n";
  EXPECT_EQ(run("run f.yaml --out f").exit_code, 1);
  EXPECT_EQ(run("run f.yaml --out f --failed-cells-ok").exit_code, 0) << "of an earlier run";
  EXPECT_EQ(run("run f.yaml --out g --shard 1/1 --failed-cells-ok").exit_code, 0);
  EXPECT_EQ(run("run f.yaml --out g --shard 1/1 --failed-cells-ok --only none").exit_code, 2);
}

TEST_F(ShardCli, BadArgumentsAreRejected) {
  for (const char* arguments : {"run c.yaml --shard 3/2",
                                "run c.yaml --shard x",
                                "run c.yaml --stage node",
                                "submit c.yaml --array 0",
                                "submit c.yaml --print --header nowhere",
                                "submit c.yaml --print -- --shards 2"}) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.out << result.err;
    EXPECT_NE(result.err, "") << arguments;
  }
}

}  // namespace
}  // namespace loopbench::shard_cli_test
