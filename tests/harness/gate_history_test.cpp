/// `check --history`: what changed between stored baselines.
#include <gtest/gtest.h>

#include "harness/compare/baseline_file.hpp"
#include "tests/support/command.hpp"
#include "tests/support/gate_snapshot.hpp"
#include "tests/support/matplotlib.hpp"

namespace loopbench::gate_history_test {

using namespace harness;
using namespace gate_snapshot;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class GateHistory : public testing::Test {
 protected:
  void write(const std::string& file, const std::function<void(Snapshot&)>& change) {
    Baseline own = baseline();
    own.build_summary = {{"loopbench", "1.2"}, {"commit", file + " of 40 hexadecimal digits"}};
    change(own.snapshot);
    folder_.file(file, json(own));
  }

  CommandResult history(const std::string& arguments) {
    return loopbench_command("check --history " + arguments, folder_);
  }

  void SetUp() override {
    write("a.json", [](Snapshot&) {});
    write("b.json", [](Snapshot& now) { rmse(now, 3) *= 1.0011; });
    write("c.json", [](Snapshot& now) { rmse(now, 3) *= 1.0011; });
  }

  TemporaryFolder folder_;
};

TEST_F(GateHistory, NamesTheStepTheCellAndBothValues) {
  const CommandResult result = history("a.json b.json c.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(has(result.out, "### a.json (1.2, a.json of 40) -> b.json (1.2, b.json of 40)\n"));
  EXPECT_TRUE(has(result.out, "room (repeat 1) / uniform")) << result.out;
  EXPECT_TRUE(has(result.out, "rmse 0.550605 m, was 0.55 (+0.11 %, limit 0.000551)")) << result.out;
  EXPECT_TRUE(has(result.out, "- changed: uniform (1 cell)\n")) << result.out;
  EXPECT_TRUE(has(result.out, "c.json (1.2, c.json of 40)\n\n- no change\n")) << result.out;
  EXPECT_TRUE(has(result.out, "3 baselines: 1 of 2 steps with changes\n")) << result.out;
  EXPECT_TRUE(has(history("b.json c.json").out, "2 baselines: nothing changed\n"));
}

TEST_F(GateHistory, ComparesValuesUnderOtherDefinitions) {
  write("c.json", [](Snapshot& now) { now.sequences["room"] = "path=room, laps=2"; });
  const CommandResult result = history("a.json c.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(has(result.out, "defines the sequence 'room' differently")) << result.out;
  EXPECT_TRUE(has(result.out, "- 0 regressions, 0 improvements")) << result.out;
}

TEST_F(GateHistory, ReadsFormatThreeWhichHasNoDigest) {
  std::string text = read_all(folder_.path() / "a.json");
  text.replace(text.find("baseline\": 4"), 12, "baseline\": 3");
  text.erase(text.find("\"digest\""), text.find("\"sweep\"") - text.find("\"digest\""));
  folder_.file("old.json", text);
  EXPECT_TRUE(has(history("old.json c.json").out, "uniform (1 cell)"));
}

TEST_F(GateHistory, GoesOnAfterAnotherSweep) {
  write("other.json", [](Snapshot& now) {
    for (GateCell& cell : now.cells) cell.sequence = "city";
  });
  const CommandResult result = history("a.json other.json a.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(has(result.out, "values are not compared: the baseline is from an")) << result.out;
  EXPECT_TRUE(has(result.out, "3 baselines: 2 of 2 steps with changes")) << result.out;
}

TEST_F(GateHistory, RejectsWhatIsNoHistory) {
  const auto error = [&](const std::string& arguments) {
    const CommandResult result = history(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_EQ(error("a.json"), "loopbench: --history: expected at least two baselines\n");
  folder_.file("edited.json", "{\"loopbench_baseline\": 4}");
  EXPECT_TRUE(has(error("a.json edited.json"), "edited.json: digest: found none"));
  EXPECT_TRUE(has(error("a.json b.json --chart x.txt"), "expected a name that ends in svg"));
  EXPECT_TRUE(has(error("a.json b.json --chart x.svg --where metric=rpe"),
                  "a.json: --where 'metric=rpe' selects no score"));
}

// `uniform` doubles, `raw` keeps its mean although one run is missing.
TEST_F(GateHistory, DrawsMeansRelativeToTheFirstBaseline) {
  if (!has_matplotlib()) GTEST_SKIP() << "needs python3-matplotlib";
  write("b.json", [](Snapshot& now) {
    for (std::size_t i = 1; i < now.cells.size(); i += 2) rmse(now, i) *= 2.0;
    now.cells.erase(now.cells.begin());
  });
  ASSERT_EQ(history("a.json b.json --chart h.svg").exit_code, 0);
  const std::string drawn = read_all(folder_.path() / "h.svg");
  EXPECT_TRUE(has(drawn, ">quick: ate translation 3d, dense, loopbench, rmse, relative to the"));
  EXPECT_LT(drawn.find(">uniform<"), drawn.find(">raw<"));
  EXPECT_TRUE(has(drawn, ">2.0<") && has(drawn, ">1.0<") && !has(drawn, ">0.8<")) << drawn;
  ASSERT_EQ(history("a.json b.json --chart again.svg").exit_code, 0);
  EXPECT_EQ(drawn, read_all(folder_.path() / "again.svg"));
}

}  // namespace
}  // namespace loopbench::gate_history_test
