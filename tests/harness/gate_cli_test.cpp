/// `check` on real stores: equal labels must have equal definitions.
#include <gtest/gtest.h>

#include <algorithm>

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
}

// Times of updates differ between runs, as the times of cells do.
TEST_F(GateCli, ComparesTimesOfUpdatesOnlyOnRequest) {
  const auto replay = [&] {
    folder_.file("replay.yaml",
                 "datasets: [{dataset: simulated, label: room, keyframes: 40}]\n"
                 "methods: [{method: online + uniform}, {method: online + dual}]\n"
                 "metrics: [ate, {metric: update_time, label: latency}]\nrepeats: 2\n");
    const CommandResult ran = call("run replay.yaml --out replay --fresh");
    ASSERT_EQ(ran.exit_code, 0) << ran.err;
  };
  const auto limited = [&] {
    std::vector<std::string> out;
    const Baseline written = read_baseline(folder_.path() / "r.json");
    for (const GateScore& score : written.snapshot.cells.at(0).scores) {
      const bool is_new = std::ranges::count(out, score.unit.text()) == 0;
      if (score.metric != "ate" && is_new) out.push_back(score.unit.text());
    }
    return out;
  };
  replay();
  ASSERT_EQ(call("check replay --baseline r.json --update --allow-dirty").exit_code, 0);
  EXPECT_TRUE(limited().empty());
  replay();
  const CommandResult again = call("check replay --baseline r.json --allow-dirty");
  EXPECT_EQ(again.exit_code, 0) << again.out;
  const std::string timed = "check replay --baseline r.json --update --allow-dirty --time ";
  ASSERT_EQ(call(timed + "0.5").exit_code, 0);
  EXPECT_EQ(limited(), (std::vector<std::string>{"s", "ms"}));  // neither misses nor growth
  ASSERT_EQ(call(timed + "1000").exit_code, 0);
  EXPECT_EQ(read_limits(folder_.path() / "r.json").size(), 3u);
  replay();
  const CommandResult loose = call("check replay --baseline r.json --allow-dirty");
  EXPECT_EQ(loose.exit_code, 0) << loose.out;
  // A sweep without replays has no such limit.
  ASSERT_EQ(call("check out --baseline b.json --update --allow-dirty --time 1").exit_code, 0);
  EXPECT_EQ(read_limits(folder_.path() / "b.json").size(), 2u);
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
