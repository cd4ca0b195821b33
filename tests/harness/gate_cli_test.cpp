/// `check` on real stores: equal labels must have equal definitions.
#include <gtest/gtest.h>

#include "harness/compare/baseline_file.hpp"
#include "tests/support/command.hpp"

namespace loopbench::gate_cli_test {

using namespace harness;

namespace {

class GateCli : public testing::Test {
 protected:
  CommandResult call(const std::string& arguments) { return loopbench_command(arguments, folder_); }

  void sweep(const std::string& uniform,
             const std::string& rpe = "rpe, delta: 1",
             const std::string& group = "") {
    folder_.file("quick.yaml",
                 "datasets: [{dataset: simulated, label: room, keyframes: 40" + group +
                     "}]\n"
                     "methods: [raw, {method: " +
                     uniform +
                     ", label: mine}]\n"
                     "metrics: [ate, {metric: " +
                     rpe + ", label: motion}]\nrepeats: 2\n");
    const CommandResult ran = call("run quick.yaml --out out --fresh");
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  }

  std::string refused() {
    const CommandResult result = call("check out --baseline b.json --allow-dirty");
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return result.err;
  }

  void SetUp() override {
    sweep("uniform");
    ASSERT_EQ(call("check out --baseline b.json --update --allow-dirty").exit_code, 0);
  }

  TemporaryFolder folder_;
};

TEST_F(GateCli, PassesTheSameSweepRunAgain) {
  sweep("uniform");
  const CommandResult result = call("check out --baseline b.json --allow-dirty");
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_NE(result.out.find("no test for small consistent losses of 2 methods"), std::string::npos)
      << result.out;
}

TEST_F(GateCli, NamesAMethodThatIsAnotherUnderItsLabel) {
  sweep("two_pass");
  EXPECT_NE(refused().find("defines the method 'mine' differently"), std::string::npos)
      << refused();
  sweep("uniform, rotation: none");
  EXPECT_NE(refused().find("these results have 'rotation=none'"), std::string::npos) << refused();
}

TEST_F(GateCli, NamesAMetricThatIsAnotherUnderItsLabel) {
  sweep("uniform", "rpe, delta: 10");
  EXPECT_NE(refused().find("defines the metric 'motion' differently"), std::string::npos)
      << refused();
  sweep("uniform", "ape");
  EXPECT_NE(refused().find("defines the metric 'motion' differently"), std::string::npos)
      << refused();
}

// One group for all runs would leave no test that can fail.
TEST_F(GateCli, NamesASequenceWhoseRunsAreInAnotherGroup) {
  sweep("uniform", "rpe, delta: 1", ", group: all");
  EXPECT_NE(refused().find("these results have 'group:all'"), std::string::npos) << refused();
}

TEST_F(GateCli, RejectsABaselineOfAnUncommittedBuild) {
  Baseline dirty = read_baseline(folder_.path() / "b.json");
  dirty.build_summary["source"] = "dirty";
  folder_.file("b.json", json(dirty));
  const CommandResult result = call("check out --baseline b.json");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("was written by a build with uncommitted changes"), std::string::npos)
      << result.err;
  EXPECT_EQ(call("check out --baseline b.json --allow-dirty").exit_code, 0);
}

TEST_F(GateCli, SaysThatAnOldBaselineHasToBeWrittenAnew) {
  folder_.file("b.json", "{\"loopbench_baseline\": 2}");
  EXPECT_NE(refused().find("found format 2, expected 4"), std::string::npos) << refused();
}

}  // namespace
}  // namespace loopbench::gate_cli_test
