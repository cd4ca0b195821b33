/// Completions of the real commands.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::pages_test {
namespace {

class Pages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(loopbench_command("pages pages", *folder_).exit_code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string page(const std::string& name) {
    return read_all(folder_->path() / "pages" / name);
  }
  /// Exit code of a shell command in the folder of the pages; 127 if the program is missing.
  static int shell(const std::string& program, const std::string& line) {
    if (std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) != 0) return 127;
    const std::string in = "cd '" + (folder_->path() / "pages").string() + "' && " + line;
    return WEXITSTATUS(std::system(in.c_str()));
  }
  static TemporaryFolder* folder_;
};
TemporaryFolder* Pages::folder_ = nullptr;

TEST_F(Pages, EveryCommandOfHelpIsListed) {
  const std::string commands = page("commands");
  EXPECT_NE(commands.find("\nrun\tRun the sweep of a config"), std::string::npos) << commands;
  EXPECT_NE(commands.find("\ntraj crop\t"), std::string::npos) << commands;
  EXPECT_EQ(commands.find("\npages\t"), std::string::npos) << "hidden";
}

TEST_F(Pages, BashCompletesCommandsOptionsAndChoices) {
  const auto completed = [](const std::string& words) {
    const std::string line =
        "bash -c '. ./loopbench.bash; COMP_WORDS=(loopbench " + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _loopbench; echo ${COMPREPLY[@]}' >out";
    EXPECT_EQ(shell("bash", line), 0);
    return page("out");
  };
  EXPECT_EQ(completed("ta"), "table\n");
  EXPECT_EQ(completed("table x --sp"), "--split\n");
  EXPECT_EQ(completed("table x --format la"), "latex\n");
  EXPECT_EQ(completed("run c --retry f"), "failed\n");
  EXPECT_EQ(completed("help ru"), "run\n");
  EXPECT_EQ(completed("traj cr"), "crop\n");
  EXPECT_EQ(completed("traj crop x --rel"), "--relative\n");
  EXPECT_EQ(completed("traj convert x --to eu"), "euroc\n");
  EXPECT_EQ(completed("run som"), "\n");  // files, by bash itself
}

TEST_F(Pages, OtherShellsAcceptTheirs) {
  const int zsh = shell("zsh", "zsh -n _loopbench");
  EXPECT_TRUE(zsh == 0 || zsh == 127) << zsh;
  const int fish = shell("fish", "fish --no-execute loopbench.fish");
  EXPECT_TRUE(fish == 0 || fish == 127) << fish;
  EXPECT_EQ(page("_loopbench").find("#compdef loopbench\n"), 0u);
  EXPECT_NE(page("loopbench.fish").find("__fish_seen_subcommand_from run' -s j -l jobs -r"),
            std::string::npos)
      << page("loopbench.fish");
  EXPECT_NE(page("loopbench.fish")
                .find("'__fish_seen_subcommand_from traj; and __fish_seen_subcommand_from plot' -"),
            std::string::npos);
  EXPECT_NE(page("_loopbench").find("_loopbench_traj() {\n"), std::string::npos);
}

}  // namespace
}  // namespace loopbench::pages_test
