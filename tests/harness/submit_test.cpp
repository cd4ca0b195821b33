/// `submit`: quoting of scripts, jobs and their order.
#include <gtest/gtest.h>

#include <cstdlib>

#include "harness/commands/submit/slurm_scripts.hpp"
#include "tests/support/command.hpp"

namespace loopbench::submit_test {

using namespace harness;

namespace {

const std::string kHostile = "a b'; touch pwned; \"$(touch pwned)\" `touch pwned` #\n&";

class Submit : public testing::Test {
 protected:
  Submit() {
    std::filesystem::create_directories(folder_.path() / "logs");
    std::filesystem::create_directory_symlink(folder_.path(), hostile_);
    program("program", "printf '%s\\n' \"$@\" >>\"${0%/*}/words\"\n");
  }

  void program(const std::string& name, const std::string& text) {
    const std::filesystem::path file = folder_.file(name, "#!/bin/bash\n" + text);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }

  std::string read(const std::string& name) { return read_all(folder_.path() / name); }

  int bash(const std::string& script, const std::string& variables = "") {
    folder_.file("script.sh", script);
    const std::string line = "cd '" + folder_.path().string() + "' && PATH=\"$PWD:$PATH\" " +
                             variables + " bash script.sh >out.txt 2>&1 </dev/null";
    return WEXITSTATUS(std::system(line.c_str()));
  }

  SlurmSweep sweep() {
    return {kHostile,
            hostile_ / "program",
            "/configs/" + kHostile + ".yaml",
            hostile_ / "out",
            3,
            {"--only=" + kHostile, "--data", hostile_ / "data"},
            "#SBATCH --time=2:00:00\nexport LOADED=1"};
  }

  TemporaryFolder folder_;
  std::filesystem::path hostile_ = folder_.path() / kHostile;  ///< another name of the folder
};

TEST_F(Submit, NoTextBecomesACommand) {
  EXPECT_EQ(bash(slurm_shard_script(sweep()), "SLURM_ARRAY_TASK_ID=2 SLURM_CPUS_PER_TASK=4"), 0);
  const std::string out = (hostile_ / "out").string();
  EXPECT_EQ(read("words"),
            "run\n/configs/" + kHostile + ".yaml\n--out\n" + out + "\n--only=" + kHostile +
                "\n--data\n" + (hostile_ / "data").string() + "\n--shard\n2/3\n--jobs\n4\n");
  folder_.file("words", "");
  EXPECT_EQ(bash(slurm_merge_script(sweep())), 2) << "no shard has a store";
  folder_.file("out/shards/1-of-3/results.sqlite", "");
  EXPECT_EQ(bash(slurm_merge_script(sweep())), 0) << read("out.txt");
  EXPECT_EQ(read("words"),
            "merge\n--add\n" + out + "/shards/1-of-3/results.sqlite\n-o\n" + out + "\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "pwned"));
}

TEST_F(Submit, TasksFailUnlessTheirCellsHaveRun) {
  for (const auto& [code, expected] : {std::pair{0, 0}, {1, 0}, {2, 2}, {130, 130}}) {
    program("program", "exit " + std::to_string(code) + "\n");
    EXPECT_EQ(bash(slurm_shard_script(sweep()), "SLURM_ARRAY_TASK_ID=1"), expected);
  }
}

TEST_F(Submit, TheHeaderFollowsOurOptions) {
  for (const std::string& script : {slurm_shard_script(sweep()), slurm_merge_script(sweep())}) {
    const std::size_t header = script.find("#SBATCH --time=2:00:00\nexport LOADED=1\n");
    EXPECT_NE(header, std::string::npos) << script;
    EXPECT_LT(script.rfind("#SBATCH"), script.find("export")) << "sbatch reads none after commands";
    EXPECT_LT(script.find("#SBATCH --job-name=a_b"), header);
    if (std::system("command -v shellcheck >/dev/null") != 0) continue;
    folder_.file("checked.sh", script);
    const std::string line = "shellcheck -e SC2016,SC2289 '" +
                             (folder_.path() / "checked.sh").string() + "' >'" +
                             (folder_.path() / "found").string() + "'";
    EXPECT_EQ(std::system(line.c_str()), 0) << read("found") << script;
  }
}

}  // namespace
}  // namespace loopbench::submit_test
