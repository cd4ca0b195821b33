/// `check` on real stores: equal labels must have equal definitions.
#include <gmock/gmock.h>

#include <algorithm>

#include "harness/compare/baseline_file.hpp"
#include "tests/support/command.hpp"

namespace loopbench::gate_cli_test {

using namespace harness;
using testing::HasSubstr;

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

  std::string checked(int expected_exit, const std::string& files = "out --baseline b.json") {
    const CommandResult result = call("check " + files + " --allow-dirty");
    EXPECT_EQ(result.exit_code, expected_exit) << result.err << result.out;
    return result.err;
  }
  std::string refused() { return checked(2); }

  void SetUp() override {
    sweep("uniform");
    checked(0, "out --baseline b.json --update");
  }

  TemporaryFolder folder_;
};

TEST_F(GateCli, PassesTheSameSweepRunAgain) {
  sweep("uniform");
  checked(0);
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
    const auto first = by_cell(written.snapshot.records).at(0);
    for (const Record& score : first) {
      const ScoreKind& kind = *score.kind;
      const bool is_new = std::ranges::count(out, kind.unit) == 0;
      if (kind.metric != "ate" && is_new) out.push_back(kind.unit);
    }
    return out;
  };
  replay();
  checked(0, "replay --baseline r.json --update");
  EXPECT_TRUE(limited().empty());
  replay();
  checked(0, "replay --baseline r.json");
  const std::string timed = "replay --baseline r.json --update --time ";
  checked(0, timed + "0.5");
  EXPECT_EQ(limited(), (std::vector<std::string>{"s", "ms"}));  // neither misses nor growth
  checked(0, timed + "1000");
  EXPECT_EQ(read_limits(folder_.path() / "r.json").size(), 3u);
  replay();
  checked(0, "replay --baseline r.json");
  // A sweep without replays has no such limit.
  checked(0, "out --baseline b.json --update --time 1");
  EXPECT_EQ(read_limits(folder_.path() / "b.json").size(), 2u);
}

TEST_F(GateCli, NamesWhatIsAnotherUnderItsLabel) {
  sweep("two_pass");
  EXPECT_THAT(refused(), HasSubstr("defines the method 'mine' differently"));
  sweep("uniform, rotation: none");
  EXPECT_THAT(refused(), HasSubstr("these results have 'rotation=none'"));
  for (const char* const metric : {"rpe, delta: 10", "ape"}) {
    sweep("uniform", metric);
    EXPECT_THAT(refused(), HasSubstr("defines the metric 'motion' differently")) << metric;
  }
  sweep("uniform", "rpe, delta: 1", ", group: all");
  EXPECT_THAT(refused(), HasSubstr("these results have 'group:all'"));
}

TEST_F(GateCli, RejectsABaselineOfAnUncommittedBuild) {
  Baseline dirty = read_baseline(folder_.path() / "b.json");
  dirty.build_summary["source"] = "dirty";
  folder_.file("b.json", json(dirty));
  const CommandResult result = call("check out --baseline b.json");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("was written by a build with uncommitted changes"));
  checked(0);
}

TEST_F(GateCli, SaysThatAnOldBaselineHasToBeWrittenAnew) {
  folder_.file("b.json", "{\"loopbench_baseline\": 2}");
  EXPECT_THAT(refused(), HasSubstr("found format 2, expected 5"));
}

}  // namespace
}  // namespace loopbench::gate_cli_test
