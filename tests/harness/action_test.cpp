/// The script of the GitHub action and of the template for GitLab.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "tests/support/command.hpp"

namespace loopbench::action_test {
namespace {

using testing::HasSubstr;

class Action : public testing::Test {
 protected:
  int action(const std::string& arguments) {
    const std::string line = "cd '" + folder_.path().string() +
                             "' && LOOPBENCH='" LOOPBENCH_BINARY "' bash '" LOOPBENCH_CONFIGS
                             "/../cmake/package/action.sh' " +
                             arguments + " >out 2>err";
    return WEXITSTATUS(std::system(line.c_str()));
  }
  std::string text(const std::string& file) { return read_all(folder_.path() / file); }
  void write_config(const std::string& options = "") {
    folder_.file("c.yaml",
                 "datasets: [{dataset: simulated, label: a, keyframes: 40" + options +
                     "}]\nmethods: [raw, uniform]\nmetrics: [ate]\n");
  }
  void SetUp() override { write_config(); }
  TemporaryFolder folder_;
};

TEST_F(Action, WritesCommentAndReport) {
  ASSERT_EQ(action("c.yaml report"), 0) << text("err");
  const std::string comment = text("report/comment.md");
  EXPECT_EQ(comment.find("## loopbench: c.yaml\n\n### ate [m], dense"), 0u) << comment;
  EXPECT_THAT(comment, HasSubstr("\n- translation ate, rmse [m], dense, loopbench: "));
  EXPECT_EQ(comment.find("next:"), std::string::npos) << comment;
  EXPECT_EQ(text("report/report.html").find("<!DOCTYPE html>"), 0u);
  EXPECT_EQ(text("out"), comment);
  EXPECT_NE(text("report/badge.svg").find(">no baseline<"), std::string::npos);
}

TEST_F(Action, TheTemplateForGitLabRunsIt) {
  const YAML::Node job =
      YAML::LoadFile(LOOPBENCH_CONFIGS "/../cmake/package/gitlab.yml")[".loopbench"];
  folder_.file("job.sh",
               "set -eu\nexport LOOPBENCH='" LOOPBENCH_BINARY
               "' LOOPBENCH_ACTION=" LOOPBENCH_CONFIGS
               "/../cmake/package/action.sh LOOPBENCH_CONFIG=c.yaml LOOPBENCH_BASELINE=\n" +
                   job["script"][0].as<std::string>() + "\nLOOPBENCH_TOKEN=\n" +
                   job["after_script"][0].as<std::string>());
  const std::string line = "cd '" + folder_.path().string() + "' && sh job.sh >out 2>err";
  ASSERT_EQ(std::system(line.c_str()), 0) << text("err");
  const auto kept = job["artifacts"]["paths"][0].as<std::string>();
  EXPECT_EQ(text(kept + "/comment.md"), text("out"));
}

TEST_F(Action, FailsIfTheSweepGotWorse) {
  ASSERT_EQ(action("c.yaml report"), 0);
  successful_command("check report/results --baseline b.json --update --allow-dirty", folder_);
  const std::string baseline = text("b.json");
  // 2: a baseline of a build with uncommitted changes.
  const int code = loopbench_command("check report/results --baseline b.json", folder_).exit_code;
  EXPECT_EQ(action("c.yaml report b.json"), code);
  const std::string outcome = code == 0 ? ">passed<" : ">failed<";
  EXPECT_NE(text("report/badge.svg").find(outcome), std::string::npos);
  write_config(", noise: {gain: 3}");
  EXPECT_NE(action("c.yaml worse b.json"), 0);
  EXPECT_EQ(text("worse/badge.svg").find(">passed<"), std::string::npos);
  EXPECT_THAT(text("worse/comment.md"), HasSubstr("### Comparison with b.json"));
}

TEST_F(Action, ReportsABadConfig) {
  folder_.file("c.yaml", "datasets: [simulated]\nmethods: [rw]\nmetrics: [ate]\n");
  EXPECT_EQ(action("c.yaml report"), 2);
  EXPECT_NE(text("report/badge.svg").find(">failed<"), std::string::npos);
  EXPECT_THAT(text("report/comment.md"), HasSubstr("c.yaml:2: no method is named 'rw'"));
}

}  // namespace
}  // namespace loopbench::action_test
