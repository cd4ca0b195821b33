/// Shards through the command line: run, merge, complete, verify, submit.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "harness/cluster/run_program.hpp"
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
                                "submit c.yaml --dry-run --partition 'a b'",
                                "submit c.yaml --dry-run --partition 'a;x'",
                                "submit c.yaml --dry-run --account '$(x)'",
                                "submit c.yaml --dry-run --qos \"a'b\"",
                                "submit c.yaml --dry-run --constraint '`x`'",
                                "submit c.yaml --dry-run --time '5; x'",
                                "submit c.yaml --dry-run --memory '1GiB\nx'",
                                "submit c.yaml --dry-run --array 0",
                                "submit c.yaml --dry-run --time 5",
                                "submit c.yaml --dry-run --memory 1GiB",
                                "watch .",
                                "cancel ."}) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.out << result.err;
    EXPECT_NE(result.err, "") << arguments;
  }
}

TEST_F(ShardCli, DryRunPrintsBothScripts) {
  const CommandResult result = run("submit c.yaml --dry-run --array 5 --time 1:00:00 --cores 2");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("#SBATCH --array=1-5\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" merge --add "), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(at("results"))) << "writes nothing";
}

TEST_F(ShardCli, LocalEngineRunsAndMerges) {
  ASSERT_EQ(run("run c.yaml --out whole").exit_code, 0);
  const CommandResult submitted =
      run("submit c.yaml --engine local --array 2 --out o --stage node");
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  const CommandResult watched = run("watch o --every 0.1");
  EXPECT_EQ(watched.exit_code, 0) << watched.out << read_all(at("o/logs/local.txt"));
  EXPECT_NE(watched.out.find("12 of 12 cells done"), std::string::npos) << watched.out;
  EXPECT_EQ(store_text(at("o")), store_text(at("whole")));
  EXPECT_EQ(run("cancel o").exit_code, 0) << "nothing is left to end";
}

TEST_F(ShardCli, WatchCountsOnlyTheLastSubmission) {
  const auto submitted = [&](const std::string& options) {
    const CommandResult result = run("submit c.yaml --engine local --out o " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const CommandResult watched = run("watch o --every 0.1");
    EXPECT_EQ(watched.exit_code, 0) << watched.out << read_all(at("o/logs/local.txt"));
    return result.out + watched.out;
  };
  EXPECT_NE(submitted("--array 3 --only 'a / '").find("6 of 6 cells done"), std::string::npos);
  const std::string missing = submitted("--array 2 --missing");
  EXPECT_NE(missing.find("6 cells in 2 shards"), std::string::npos) << missing;
  EXPECT_NE(missing.find("6 of 6 cells done"), std::string::npos) << missing;
  EXPECT_EQ(run("submit c.yaml --engine local --out o --missing").out, "no cells are missing\n");
  const std::string all = submitted("--array 2");
  EXPECT_NE(all.find("12 of 12 cells done"), std::string::npos) << all;
}

TEST_F(ShardCli, WatchReadsSqueueAndSacct) {
  std::filesystem::create_directories(at("o/shards/1-of-3"));
  std::ofstream(at("o/submission.txt")) << "engine slurm\ncells 12\nshards 3\njob 12\nmerge 13\n";
  std::ofstream(at("o/shards/1-of-3/progress")) << "5 6 1\n";
  const std::string path = getenv("PATH");
  setenv("PATH", (folder_.path().string() + ":" + path).c_str(), 1);
  const auto watched = [&](const std::string& squeue, const std::string& options) {
    std::ofstream(at("squeue")) << "#!/bin/sh\n" << squeue << "\n";
    std::ofstream(at("sacct")) << "#!/bin/sh\nprintf 'COMPLETED\\nCANCELLED by 0\\n'\n";
    for (const char* name : {"squeue", "sacct"}) {
      std::filesystem::permissions(at(name), std::filesystem::perms::owner_all);
    }
    return run("watch o " + options);
  };
  // Also jobs of others, which do not count.
  const std::string tasks = "printf '12 RUNNING\\n12 PENDING\\n13 PENDING\\n14 RUNNING\\n'";
  const CommandResult running = watched(tasks, "--once");
  EXPECT_EQ(running.out,
            "5 of 12 cells done, 1 failed; 2 pending, 1 running; all jobs: 1 cancelled, 1 "
            "completed\n");
  EXPECT_EQ(running.exit_code, 0);
  const CommandResult failing = watched("exit 1", "--once");
  EXPECT_NE(failing.out.find("; squeue fails"), std::string::npos) << failing.out;
  EXPECT_EQ(failing.exit_code, 0) << "jobs can be left";
  const CommandResult ended = watched("printf '14 RUNNING\\n'", "");
  EXPECT_NE(ended.out.find("no jobs are left; no store was merged"), std::string::npos)
      << ended.out;
  EXPECT_EQ(ended.exit_code, 1);
  setenv("PATH", path.c_str(), 1);
}

TEST_F(ShardCli, JobsOfAnEarlierSubmissionAreNotDisturbed) {
  // Records of submissions whose processes exist: of this test, and of one that has ended.
  std::filesystem::create_directories(at("o"));
  const auto record = [&](const std::string& started) {
    std::ofstream(at("o/submission.txt"))
        << "engine local\ncells 12\nprocess " << getpid() << "\nstarted " << started << "\n";
  };
  record(harness::start_of_process(getpid()));
  const CommandResult second = run("submit c.yaml --engine local --array 2 --out o");
  EXPECT_EQ(second.exit_code, 2) << second.out;
  EXPECT_NE(second.err.find("jobs of an earlier submission have not ended"), std::string::npos)
      << second.err;
  record("1");
  EXPECT_EQ(run("submit c.yaml --engine local --array 2 --out o").exit_code, 0);
  EXPECT_EQ(run("watch o --every 0.1").exit_code, 0);
}

}  // namespace
}  // namespace loopbench::shard_cli_test
