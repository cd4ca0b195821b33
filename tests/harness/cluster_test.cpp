/// Scripts for clusters: quoting, signals, settings.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "datasets/core/error.hpp"
#include "harness/cluster/progress_file.hpp"
#include "harness/cluster/scripts.hpp"
#include "harness/cluster/settings.hpp"
#include "harness/cluster/submission.hpp"
#include "tests/support/command.hpp"

namespace loopbench::cluster_test {

using namespace harness;

namespace {

const std::string kHostile = "a b'; touch pwned; \"$(touch pwned)\" `touch pwned` #\n&";

class ClusterScripts : public testing::Test {
 protected:
  ClusterScripts() {
    std::filesystem::create_directories(folder_.path() / "logs");
    std::filesystem::create_directory_symlink(folder_.path(), hostile_);
    // Writes its words, one per line, into a file named after the shard.
    write("program",
          "#!/bin/bash\nout=words\nfor word; do [[ $last == --shard ]] && out=${word%/*}\n"
          "last=$word; done\nprintf '%s\\n' \"$@\" >\"${0%/*}/words-$out\"\n");
  }

  void write(const std::string& name, const std::string& text) {
    const std::filesystem::path file = folder_.path() / name;
    std::ofstream(file) << text;
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }

  std::string read(const std::string& name) { return read_all(folder_.path() / name); }

  int bash(const std::string& script, const std::string& variables = "") {
    write("script.sh", script);
    const std::string line = "cd '" + folder_.path().string() + "' && PATH=\"$PWD:$PATH\" " +
                             variables + " bash script.sh >out.txt 2>&1 </dev/null";
    return WEXITSTATUS(std::system(line.c_str()));
  }

  SubmittedSweep sweep() {
    return {kHostile,
            hostile_ / "program",
            "/configs/" + kHostile + ".yaml",
            hostile_ / "out",
            {"--only=" + kHostile, "--data", hostile_ / "data"}};
  }

  TemporaryFolder folder_;
  std::filesystem::path hostile_ = folder_.path() / kHostile;  ///< another name of the folder
};

TEST_F(ClusterScripts, NoTextBecomesACommand) {
  ClusterSettings settings;
  settings.array = 3;
  settings.cores = 2;
  bash(local_script(sweep(), settings));
  for (const std::string shard : {"1", "2", "3"}) {
    EXPECT_EQ(read("words-" + shard),
              "run\n/configs/" + kHostile + ".yaml\n--out\n" + (hostile_ / "out").string() +
                  "\n--only=" + kHostile + "\n--data\n" + (hostile_ / "data").string() +
                  "\n--shard\n" + shard + "/3\n--jobs\n2\n");
  }
  EXPECT_EQ(bash(slurm_shard_script(sweep(), settings), "SLURM_ARRAY_TASK_ID=2"), 0);
  std::filesystem::create_directories(folder_.path() / "out" / "shards" / "1-of-3");
  write("out/shards/1-of-3/results.sqlite", "");
  EXPECT_EQ(bash(slurm_merge_script(sweep(), settings)), 0) << read("out.txt");
  const std::string out = (hostile_ / "out").string();
  EXPECT_EQ(read("words-words"),
            "merge\n--add\n" + out + "/shards/1-of-3/results.sqlite\n-o\n" + out + "\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "pwned"));
  EXPECT_EQ(job_name("a b;c\n"), "a_b_c_");
}

TEST_F(ClusterScripts, OnlyTheSignalBeforeTheLimitRequeuesAShard) {
  write("scontrol", "#!/bin/bash\nprintf '%s\\n' \"$@\" >requeued\n");
  const std::string script = slurm_shard_script(sweep(), {});
  const auto run = [&] { return bash(script, "SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_JOB_ID=55"); };
  const auto signalled = [](const std::string& signals) {
    return "#!/bin/bash\ntrap 'sleep 0.1; exit 130' TERM\n" + signals +
           "for ((i = 0; i < 300; ++i)); do sleep 0.1; done\nexit 7\n";
  };
  // `scancel`, `scontrol requeue` and preemption end a task with SIGTERM.
  write("program", signalled("kill -TERM \"$PPID\"\n"));
  EXPECT_EQ(run(), 130);
  // The trap waits for the end of a program, so both signals are sent.
  write("program", signalled("bash -c \"kill -USR1 $PPID; kill -TERM $PPID\"\n"));
  EXPECT_EQ(run(), 130);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "requeued"));
  write("program", signalled("kill -USR1 \"$PPID\"\n"));
  EXPECT_EQ(run(), 0);
  EXPECT_EQ(read("requeued"), "requeue\n55_2\n");
  for (const auto& [code, expected] : {std::pair{0, 0}, {1, 0}, {2, 2}, {3, 3}}) {
    write("program", "#!/bin/bash\nexit " + std::to_string(code) + "\n");
    EXPECT_EQ(run(), expected);
  }
}

TEST_F(ClusterScripts, ACellThatWouldExceedTheLimitIsAbandoned) {
  write("scontrol", "#!/bin/bash\nprintf '%s\\n' \"$@\" >requeued\n");
  // As `run`, whose running cells end at SIGINT only, which bash cannot catch in the background.
  write("run.py",
        "import os, signal, sys, time\nsignal.signal(signal.SIGTERM, lambda *_: None)\n"
        "signal.signal(signal.SIGINT, lambda *_: os._exit(130))\nos.kill(os.getppid(), "
        "signal.SIGUSR1)\ntime.sleep(30)\ntime.sleep(30)\n");
  write("program", "#!/bin/bash\nexec /usr/bin/python3 \"${0%/*}/run.py\"\n");
  ClusterSettings settings;
  settings.signal = 1;
  EXPECT_EQ(
      bash(slurm_shard_script(sweep(), settings), "SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_JOB_ID=55"),
      0);
  EXPECT_EQ(read("requeued"), "requeue\n55_2\n");
}

TEST_F(ClusterScripts, PassShellcheck) {
  if (std::system("command -v shellcheck >/dev/null") != 0) GTEST_SKIP() << "no shellcheck";
  ClusterSettings settings;
  settings.time = "2:00:00";
  settings.memory = "4GiB";
  settings.partition = "long";
  settings.account = "lab";
  for (const std::string& script : {slurm_shard_script(sweep(), settings),
                                    slurm_merge_script(sweep(), settings),
                                    local_script(sweep(), settings)}) {
    write("checked.sh", script);
    const std::string line = "shellcheck '" + (folder_.path() / "checked.sh").string() + "' >'" +
                             (folder_.path() / "found").string() + "'";
    EXPECT_EQ(std::system(line.c_str()), 0) << read("found") << script;
  }
}

TEST_F(ClusterScripts, ResourcesAreRequested) {
  ClusterSettings settings;
  settings.array = 12;
  settings.cores = 4;
  settings.time = "2:00:00";
  settings.memory = "1.5GiB";
  settings.account = "lab";
  const std::string script = slurm_shard_script(sweep(), settings);
  for (const char* line : {"#SBATCH --array=1-12\n",
                           "#SBATCH --cpus-per-task=4\n",
                           "#SBATCH --time=2:00:00\n",
                           "#SBATCH --mem=1536M\n",
                           "#SBATCH --account=lab\n",
                           "#SBATCH --signal=B:USR1@120\n",
                           "#SBATCH --requeue\n"}) {
    EXPECT_NE(script.find(line), std::string::npos) << line;
  }
  EXPECT_EQ(script.find("--partition"), std::string::npos);
}

TEST_F(ClusterScripts, SettingsAreLayered) {
  write("user.yaml", "partition: short\ntime: 90\narray: 4\n");
  write("c.yaml", "cluster: {array: 6, memory: 2GiB}\n");
  const ClusterSettings found =
      cluster_settings(folder_.path() / "c.yaml", folder_.path() / "user.yaml");
  EXPECT_EQ(found.partition, "short");
  EXPECT_EQ(found.array, 6);
  EXPECT_EQ(limit_bytes(found.memory), std::int64_t{2} << 30);
  EXPECT_EQ(limit_seconds(found.time), 5400);
  for (const auto& [text, seconds] : {std::pair{"10:30", 630},
                                      {"1:00:01", 3601},
                                      {"2-12", 216000},
                                      {"1-01:01:01", 90061},
                                      {"", 0}}) {
    EXPECT_EQ(limit_seconds(text), seconds) << text;
  }
  for (const char* text : {"soon", "1:2:3:4", "-5", "1-", "0", ":", "1h"}) {
    EXPECT_THROW(limit_seconds(text), OptionError) << text;
  }
  for (const char* line : {"cluster: {partition: 'a b'}",
                           "cluster: {partition: \"a\\n#SBATCH --x\"}",
                           "cluster: {arry: 3}",
                           "cluster: {array: 0}",
                           "cluster: {array: many}",
                           "cluster: {time: soon}",
                           "cluster: {memory: big}",
                           "cluster: [1]",
                           "cluster: {array: [1]}"}) {
    write("c.yaml", line);
    EXPECT_THROW(cluster_settings(folder_.path() / "c.yaml", ""), InputError) << line;
  }
}

TEST_F(ClusterScripts, RecordsAreReadBack) {
  Submission written{Engine::slurm, 100, 4, "12", "13", 0, ""};
  write_submission(written, folder_.path());
  const Submission found = read_submission(folder_.path());
  EXPECT_EQ(found.cells, 100u);
  EXPECT_EQ(found.job, "12");
  EXPECT_EQ(found.merge_job, "13");
  EXPECT_FALSE(is_running(found));
  EXPECT_THROW(read_submission(folder_.path() / "logs"), InputError);
  write("submission.txt", "engine slurm\ncells 3\n");
  EXPECT_THROW(read_submission(folder_.path()), InputError);
  for (const std::string shard : {"1-of-2", "2-of-2"}) {
    std::filesystem::create_directories(folder_.path() / "shards" / shard);
    ProgressFile(folder_.path() / "shards" / shard).write({3, 5, 1});
  }
  const CellCounts counts = read_progress(folder_.path());
  EXPECT_EQ(counts.done, 6u);
  EXPECT_EQ(counts.total, 10u);
  EXPECT_EQ(counts.failed, 2u);
  EXPECT_EQ(read_progress(folder_.path() / "nowhere").total, 0u);
}

}  // namespace
}  // namespace loopbench::cluster_test
