/// Shards through the command line: run, merge, complete, verify.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

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
  const CommandResult missing = run("run c.yaml --out o --missing");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("found no store to complete"), std::string::npos) << missing.err;
  EXPECT_FALSE(std::filesystem::exists(at("o/table.md"))) << "only of the merged store";
  const CommandResult half = run("merge o/shards/* -o o");
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_NE(half.out.find("6 of 12 cells are missing; shards without a cell: 2/2"),
            std::string::npos)
      << half.out;
  EXPECT_NE(run("run c.yaml --out o --missing --dry-run").out.find("6 cells"), std::string::npos);
  // The missing cells (three sequences) in shards again, then the last of them without.
  ASSERT_EQ(run("run c.yaml --out o --missing --shard 1/2").exit_code, 0);
  ASSERT_EQ(run("merge --add o/shards/missing-1-of-2 -o o").exit_code, 0);
  const CommandResult rest = run("run c.yaml --out o --missing");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.out.find("12 of 12 cells done (10 of them in earlier runs)"), std::string::npos)
      << rest.out;
  EXPECT_EQ(store_text(at("o")), store_text(at("whole")));

  const CommandResult sample = run("verify c.yaml --sample 0.3 --store o --jobs 2");
  EXPECT_EQ(sample.exit_code, 0) << sample.out << sample.err;
  EXPECT_NE(sample.out.find("bit-identical"), std::string::npos) << sample.out;
}

TEST_F(ShardCli, BadArgumentsAreRejected) {
  for (const char* arguments : {"run c.yaml --shard 3/2",
                                "run c.yaml --shard x",
                                "run c.yaml --costs nowhere",
                                "run c.yaml --costs nowhere --shard 1/2",
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
