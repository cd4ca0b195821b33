/// compare, table and check as processes: formats, exit codes, messages.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/compare/baseline_file.hpp"
#include "tests/support/command.hpp"

namespace loopbench::verdict_cli_test {

using namespace harness;

namespace {

const char* const kConfig =
    "datasets:\n"
    "  - {dataset: simulated, path: driving, keyframes: 100, label: 'off|ice_&%<b>'}\n"
    "  - {dataset: simulated, path: driving, keyframes: 140, label: room}\n"
    "methods: [raw, uniform, cubic_spline]\n"
    "metrics: [ate]\n"
    "times: keyframes\n"
    "repeats: 4\n";

/// One sweep of eight runs, computed once and used by every test.
class VerdictCli : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    folder_->file("c.yaml", kConfig);
    ASSERT_EQ(run("run c.yaml --out r").exit_code, 0);
    ASSERT_EQ(run("check r --baseline b.json --update").exit_code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  /// Baselines of uncommitted sources are accepted: tests run while one works.
  static CommandResult run(const std::string& arguments) {
    const bool is_check = arguments.starts_with("check ");
    return loopbench_command(arguments + (is_check ? " --allow-dirty" : ""), *folder_);
  }
  /// The message of a command that must be rejected.
  static std::string refusal(const std::string& arguments) {
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    return result.err;
  }
  static std::string read(const std::string& name) { return read_all(folder_->path() / name); }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(VerdictCli, CompareGivesAVerdict) {
  const CommandResult result = run("compare r --where unit=m");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("### ate rmse, keyframes, loopbench\n\n| method", 0), 0u);
  EXPECT_TRUE(
      has(result.out, "\n- translation ate, rmse [m], keyframes, loopbench: uniform is best: "))
      << result.out;
  EXPECT_TRUE(has(result.out,
                  "; over 8 runs of 2 sequences\n- claims hold for more runs of these 2 sequences"))
      << result.out;
  EXPECT_EQ(run("compare r --where unit=m").out, result.out);  // reproducible
  const CommandResult few = run("compare r --where unit=m,sequence=room,repeat=0");
  EXPECT_TRUE(has(few.out, "nothing can be shown: ")) << few.out;
}

TEST_F(VerdictCli, CompareFailsWhereAnAssertionIsNotShown) {
  const std::string compared = run("compare r --where unit=m").out;
  const CommandResult shown =
      run("compare --assert 'uniform is below raw' r --where unit=m --assert 'raw is not shown to "
          "differ from raw'");
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_EQ(shown.out, compared);
  const CommandResult result =
      run("compare r --where unit=m --assert 'uniform is at least 99 % below raw' --assert 'raw is "
          "below uniform' --assert 'uniform is not above raw'");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, compared);
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 2) << result.err;
  EXPECT_TRUE(has(result.err,
                  "loopbench: assertion not shown: uniform is at least 99 % below raw: measured "))
      << result.err;
  EXPECT_TRUE(has(result.err, "raw is below uniform: measured ")) << result.err;
  EXPECT_TRUE(has(refusal("compare r --assert 'uniform is below raw'"),
                  "--assert: expected one score, found 2: ate rmse, keyframes, loopbench; ate "
                  "rotation rmse"));
  EXPECT_TRUE(has(refusal("compare r --where unit=m --assert 'unifrom is below raw'"),
                  "no method is named 'unifrom'; did you mean 'uniform'?"));
  EXPECT_TRUE(has(refusal("compare r --where unit=m --assert 'uniform is better'"),
                  "expected 'A is below B', 'A is at least X % below B'"));
}

TEST_F(VerdictCli, CompareSpeaksEveryFormat) {
  EXPECT_EQ(run("compare r --format json").out.rfind("{\n\"provenance\": {\n", 0), 0u);
  const CommandResult printed = run("compare r --format csv");
  EXPECT_EQ(printed.out.rfind("protocol,times,metric", 0), 0u);
  EXPECT_TRUE(has(printed.err, "loopbench: loopbench 0.")) << "what made it: " << printed.err;
  EXPECT_TRUE(has(run("compare r --format latex").out, "\\begin{tabular}{lrrrrrrr}\n\\toprule"));
  EXPECT_TRUE(
      has(run("compare r --format terminal").out, "ate rmse, keyframes, loopbench\nmethod "));
}

TEST_F(VerdictCli, CompareRefusesByName) {
  EXPECT_EQ(refusal("compare r --baseline unifrom"),
            "loopbench: baseline: no method is named 'unifrom'; did you mean 'uniform'?\n");
  EXPECT_EQ(refusal("compare r --metric aet"),
            "loopbench: --metric: no metric is named 'aet'; did you mean 'ate'?\n");
  EXPECT_TRUE(has(refusal("compare r --value rms"), "did you mean 'rmse'?"));
  EXPECT_TRUE(has(refusal("compare r --where metrc=ate"), "did you mean 'metric'?"));
  EXPECT_TRUE(has(refusal("compare r --where sequence=nowhere"), "no score to compare"));
  EXPECT_TRUE(has(refusal("compare nowhere"), "nowhere: file not found"));
  EXPECT_TRUE(has(refusal("compare c.yaml"), "c.yaml: "));
  refusal("compare r --alpha 2");
  refusal("compare r --over planets");
  folder_->file("empty.sqlite", "");
  EXPECT_TRUE(has(refusal("compare empty.sqlite"), "empty.sqlite: is not a store"));
}

TEST_F(VerdictCli, EveryExportCarriesWhatMadeIt) {
  const auto ends = [](const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
  };
  const std::string plain = run("table r").out;
  EXPECT_EQ(plain.find("\ncommit: "), std::string::npos) << plain;
  EXPECT_TRUE(has(plain, "\n<!-- source: c, loopbench ")) << plain;
  EXPECT_TRUE(has(run("compare r --format latex").out, "\n% source: c, loopbench "));
  EXPECT_FALSE(has(run("table r --columns sequence --where unit=m,metric=ate").out, "### room"));
  const std::string markdown = run("table r --provenance").out;
  const std::string comment = markdown.substr(markdown.find("<!-- provenance\n"));
  for (const char* entry : {"\ncommit: ",
                            "\ncompiler: ",
                            "\ncpu: ",
                            "\nseeds:\n",
                            "\nprotocol: ",
                            "\nconfig:\n  datasets:\n",
                            "  repeats: 4\n"}) {
    EXPECT_TRUE(has(comment, entry)) << entry << comment;
  }
  EXPECT_TRUE(ends(comment, "-->\n"));
  EXPECT_EQ(comment.find("--", 4), comment.size() - 4) << "nothing within may end it";
  const std::string latex = run("compare r --format latex --provenance").out;
  EXPECT_TRUE(has(latex, "\n% commit: "));
  EXPECT_TRUE(has(latex, "\n%   metrics: [ate]\n"));
  EXPECT_EQ(run("table r --format csv -o t/x.csv").out, "");
  EXPECT_EQ(read("t/x.csv"), run("table r --format csv").out);
  const std::string beside = read("t/x.provenance.json");
  EXPECT_TRUE(has(beside, "\"commit\": \"")) << beside;
  EXPECT_TRUE(has(beside, "\\nmetrics: [ate]\\n")) << beside;
  EXPECT_EQ(read("r/provenance.json"), beside);
  EXPECT_TRUE(has(read("r/table.md"), "<!-- provenance\n"));
  EXPECT_TRUE(has(run("table r --format json").out, "\n\"tables\": [\n"));
}

TEST_F(VerdictCli, ATableKeepsTheRowsItsConfigAsksFor) {
  std::string text = kConfig;
  folder_->file("w.yaml", text + "table: {where: ['method!=raw', unit=m], show: [ate]}\n");
  const CommandResult result = run("run w.yaml --out w --only room");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(has(result.out, "| uniform "));
  EXPECT_FALSE(has(result.out, "| raw ")) << result.out;
  EXPECT_FALSE(has(result.out, "[deg]")) << result.out;
  EXPECT_TRUE(has(read("w/rows.csv"), ",raw,"));
  folder_->file("w.yaml", text + "table: {where: [metrc=ate]}\n");
  const std::string slip = refusal("run w.yaml --dry-run");
  EXPECT_TRUE(slip.starts_with("loopbench: w.yaml:8: table.where: where: 'metrc=ate': ")) << slip;
}

TEST_F(VerdictCli, TheGateLooksAtTimesWhenTold) {
  ASSERT_EQ(run("check r --baseline t.json --update --time 0.5").exit_code, 0);
  EXPECT_TRUE(
      has(read("t.json"), "{\"where\":[\"metric=time\"],\"values\":[\"rmse\"],\"relative\":0.5"));
  EXPECT_TRUE(has(read("t.json"), "\"metric\":\"time\""));
  EXPECT_EQ(run("check r --baseline t.json").exit_code, 0);
  std::string other = read("t.json");
  const std::size_t cpu = other.find("\"time\":\"on ");
  ASSERT_NE(cpu, std::string::npos) << other;
  folder_->file("t2.json", other.insert(cpu + 11, "another "));
  refusal("check r --baseline t2.json");
  refusal("check r --baseline t.json --time 1");
}

TEST_F(VerdictCli, TheGatePassesItsOwnNumbers) {
  const CommandResult result = run("check r --baseline b.json --junit j.xml --markdown m.md");
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_EQ(result.out,
            "### c: passed\n\n- 0 regressions, 0 improvements, 0 new cells in 24 cells and 48 "
            "scores\n");
  EXPECT_EQ(read("m.md"), result.out);
  EXPECT_TRUE(has(read("j.xml"), "tests=\"24\" failures=\"0\""));
}

TEST_F(VerdictCli, AMovedNumberFailsTheGateAndIsNamed) {
  // The baseline's first error of uniform on the room, reduced by 1 %.
  Baseline moved = read_baseline(folder_->path() / "b.json");
  const auto score = std::ranges::find(
      moved.snapshot.records, "room / uniform", [](const auto& r) { return r.cell->name(); });
  ASSERT_NE(score, moved.snapshot.records.end());
  score->statistics.rmse *= 0.99;
  folder_->file("moved.json", json(moved));
  const CommandResult result = run("check r --baseline moved.json --junit moved.xml");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_TRUE(has(result.out, "### c: FAILED\n")) << result.out;
  EXPECT_TRUE(has(result.out, "| room / uniform | ate translation 3d, keyframes, loopbench |"))
      << result.out;
  EXPECT_TRUE(has(read("moved.xml"), "name=\"room / uniform\">\n    <failure "));
}

TEST_F(VerdictCli, TheGateRefusesOtherInputsAndBadFiles) {
  folder_->file("other.yaml",
                "datasets: [{dataset: simulated, path: room, keyframes: 50, label: room}]\n"
                "methods: [raw]\nmetrics: [ate]\ntimes: keyframes\n");
  EXPECT_EQ(run("run other.yaml --out o").exit_code, 0);
  EXPECT_TRUE(
      has(refusal("check o --baseline b.json"), "b.json: the baseline defines the sequence"));
  folder_->file("evo.yaml", std::string(kConfig) + "protocol: evo\n");
  EXPECT_EQ(run("run evo.yaml --out e --only 'room / raw'").exit_code, 0);
  EXPECT_TRUE(has(refusal("check e --baseline b.json"), "has the protocol 'loopbench ["));
  folder_->file("broken.json", "{\n\"loopbench_baseline\": 1,\n");
  EXPECT_TRUE(has(refusal("check r --baseline broken.json"), "broken.json:3: is not JSON: "));
  folder_->file("large.json", "{\"loopbench_baseline\": 3e99947}\n");
  EXPECT_TRUE(has(refusal("check r --baseline large.json"), "large.json: is not a baseline: "));
  EXPECT_TRUE(has(refusal("check r --baseline nowhere.json"), "nowhere.json: no such file"));
  EXPECT_TRUE(has(refusal("check nowhere --baseline b.json"), "nowhere: file not found"));
  refusal("check r");
}

TEST_F(VerdictCli, AnUpdateKeepsTheLimits) {
  std::string text = read("b.json");
  const std::size_t at = text.find("\"relative\":0.001");
  ASSERT_NE(at, std::string::npos);
  folder_->file("strict.json", text.replace(at, 16, "\"relative\":0.002"));
  EXPECT_EQ(run("check r --baseline strict.json --update").exit_code, 0);
  EXPECT_TRUE(has(read("strict.json"), "\"relative\":0.002"));
}

TEST_F(VerdictCli, NoCommandWritesOverWhatItReads) {
  const std::string store = read("r/results.sqlite");
  const std::string baseline = read("b.json");
  const std::string config = read("c.yaml");
  for (const char* arguments : {"table r -o r/results.sqlite",
                                "compare r -o ./r/../r/results.sqlite",
                                "report r -o r/results.sqlite",
                                "check r --baseline b.json --markdown b.json",
                                "check r --baseline b.json --junit r/results.sqlite"}) {
    EXPECT_TRUE(has(refusal(arguments), ": is an input of this command and is not overwritten\n"))
        << arguments;
  }
  EXPECT_EQ(read("r/results.sqlite"), store);
  EXPECT_EQ(read("b.json"), baseline);
  EXPECT_EQ(read("c.yaml"), config);
}

TEST_F(VerdictCli, PlotWritesFiguresOfChosenMethods) {
  const CommandResult result = run("plot r -o figures --methods raw,uniform --format svg");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(has(read("figures/01_off_ice_b_trajectories.svg"), "uniform"));
  EXPECT_TRUE(has(read("figures/02_room_errors.svg"), "rotation error [deg]"));
  EXPECT_EQ(read("figures/02_room_errors.pdf"), "");
  EXPECT_TRUE(has(refusal("plot r --methods unifrom"), "did you mean 'uniform'?"));
}

}  // namespace
}  // namespace loopbench::verdict_cli_test
