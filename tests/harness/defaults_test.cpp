/// loopbench.yaml.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::defaults_test {
namespace {

using testing::HasSubstr;

class Defaults : public testing::Test {
 protected:
  Defaults() {
    std::string poses;
    for (int i = 0; i < 30; ++i) {
      poses += std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i * i) +
               (i % 2 == 0 ? " 0 0 0 0 1\n" : " 0 0 0 0.6 0.8\n");
    }
    folder_.file("gt.txt", poses);
    folder_.file("a.txt", poses);
  }
  CommandResult run(const std::string& yaml, const std::string& options = "") {
    folder_.file("loopbench.yaml", yaml);
    return loopbench_command("eval gt.txt a.txt " + options, folder_);
  }
  TemporaryFolder folder_;
};

TEST_F(Defaults, OfTheFilesBesideThem) {
  const CommandResult both = run("eval:\n  protocol: evo\n  motion-filter: [0.5, 5]\n");
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("\nprotocol   evo ["));
  EXPECT_THAT(both.err, HasSubstr("loopbench.yaml sets --protocol=evo --motion_filter 0.5 5\n"));
  EXPECT_THAT(run("eval:\n  protocol: [evo, tum]\n  all_pairs: true\n").out,
              HasSubstr("tum (pairs=all) ["));
}

TEST_F(Defaults, OptionsOverruleThem) {
  const CommandResult stated = run("eval:\n  protocol: evo\n", "--protocol tum");
  EXPECT_THAT(stated.out, HasSubstr("\nprotocol   tum ["));
  EXPECT_EQ(stated.err, "");
  EXPECT_EQ(run("eval: {metric: ate}\n", "-d 1").exit_code, 0) << "--metric excludes -d";
  EXPECT_EQ(run("eval: {size: [2, 2]}\n").exit_code, 0) << "--size without --plot";
  EXPECT_EQ(run("table: {format: latex}\n").err, "");
}

TEST_F(Defaults, ChooseNoFiles) {
  for (const std::string option : {"per-pose", "plugin", "plot", "store"}) {
    const CommandResult result = run("eval:\n  " + option + ": /tmp/x\n");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("loopbench.yaml:2: no option of eval that a file can set"));
  }
  EXPECT_THAT(run("eval:\n  algin: se3\n").err, HasSubstr("did you mean 'align'?"));
  EXPECT_THAT(run("evall:\n  align: se3\n").err, HasSubstr("did you mean 'eval'?"));
  const std::string why =
      "loopbench: loopbench.yaml:1: no command with options in a file is named 'traj' (known: ";
  EXPECT_THAT(run("traj:\n  to: kitti\n").err, testing::StartsWith(why));
  EXPECT_THAT(loopbench_command("traj convert a.txt", folder_).err, testing::StartsWith(why));
  EXPECT_EQ(run("protocol: evo\n").exit_code, 2) << "without a command";
}

TEST_F(Defaults, AreShownAsAFile) {
  const CommandResult shown = run("eval: {align: sim3}\n", "--show-defaults");
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("eval:\n"));
  EXPECT_THAT(shown.out, HasSubstr("\n  align: sim3\n"));
  EXPECT_THAT(shown.out, HasSubstr("\n  # protocol: [loopbench]\n"));
  const CommandResult given =
      run("", "--align sim3 --motion_filter 0.5 5 --all_pairs --show-defaults");
  for (const char* line : {"align: sim3", "motion_filter: [0.5, 5]", "all_pairs: true"}) {
    EXPECT_THAT(given.out, HasSubstr(std::string("\n  ") + line + "\n")) << given.err;
  }
  const CommandResult again = run(shown.out);
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

}  // namespace
}  // namespace loopbench::defaults_test
