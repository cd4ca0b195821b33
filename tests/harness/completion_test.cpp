/// Shell completions.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::completion_test {
namespace {

const std::string kScripts = LOOPBENCH_CONFIGS "/../cmake/package/completions/";

int shell(const std::string& line) { return WEXITSTATUS(std::system(line.c_str())); }

TEST(Completion, ListsCommandsAndTheirMeaning) {
  const TemporaryFolder folder;
  const std::string commands = loopbench_command("complete loopbench ''", folder).out;
  EXPECT_NE(commands.find("run\tRun the sweep of a config"), std::string::npos) << commands;
  EXPECT_EQ(commands.find("complete\t"), std::string::npos) << "hidden";
  EXPECT_EQ(loopbench_command("complete loopbench run --dry", folder).out.find("--dry-run\t"), 0u);
  EXPECT_EQ(loopbench_command("complete", folder).out, "");
}

TEST(Completion, BashCompletesCommandsOptionsAndChoices) {
  const TemporaryFolder folder;
  const auto completed = [&](const std::string& words) {
    const std::string out = (folder.path() / "out").string();
    EXPECT_EQ(shell("bash -c '. " + kScripts + "loopbench.bash; COMP_WORDS=(" LOOPBENCH_BINARY " " +
                    words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _loopbench; " +
                    "echo ${COMPREPLY[@]}' >'" + out + "'"),
              0);
    return read_all(out);
  };
  EXPECT_EQ(completed("ta"), "table\n");
  EXPECT_EQ(completed("table x --sp"), "--split\n");
  EXPECT_EQ(completed("table x --format la"), "latex\n");
  EXPECT_EQ(completed("run c --retry f"), "failed\n");
  EXPECT_EQ(completed("help ru"), "run\n");
  EXPECT_EQ(completed("traj cr"), "crop\n");
  EXPECT_EQ(completed("traj crop x --rel"), "--relative\n");
  EXPECT_EQ(completed("traj convert x --to eu"), "euroc\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --protocol kitti-"), "kitti-double\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --protocol evo,hi"), "evo,hilti\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --metric path"), "path_length\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --metric ate,path"), "\n") << "is no list";
  EXPECT_EQ(completed("eval gt.txt a.txt --protocol = kitti-"), "kitti-double\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --protocol=kitti-"), "--protocol=kitti-double\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --plane ="), "xy xz yz\n");
  EXPECT_EQ(completed("compare x --metric path"), "path_length\n");
  EXPECT_EQ(completed("correct a.g2o --method uniform_"), "uniform_position uniform_open\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --align posy"), "posyaw posyaw_origin\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --ref-format eu"), "euroc\n");
  EXPECT_EQ(completed("eval gt.txt a.txt -r point_"),
            "point_distance point_distance_error_ratio\n");
  EXPECT_EQ(completed("eval gt.txt a.txt --plane x"), "xy xz\n");
  EXPECT_EQ(completed("list uniform_"), "uniform_position uniform_open\n");
  EXPECT_EQ(completed("run som"), "\n");  // files, by bash itself
}

TEST(Completion, OtherShellsAcceptTheirs) {
  for (const std::string& line :
       {"zsh -n " + kScripts + "_loopbench", "fish --no-execute " + kScripts + "loopbench.fish"}) {
    const int code = shell(line + " 2>/dev/null");
    EXPECT_TRUE(code == 0 || code == 127) << line;  // 127: not installed
  }
}

}  // namespace
}  // namespace loopbench::completion_test
