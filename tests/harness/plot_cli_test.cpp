/// `plot` as a process: a full disk and awkward labels.
#include <gtest/gtest.h>

#include <map>

#include "harness/report/draw.hpp"
#include "tests/support/command.hpp"

namespace loopbench::plot_cli_test {
namespace {

using harness::kFigureFormats;

class PlotCli : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_matplotlib()) GTEST_SKIP() << "needs python3-matplotlib";
    folder_.file("quote.yaml",
                 "datasets: [{dataset: simulated, keyframes: 40, label: \"'room\\e[1m'\"}]\n"
                 "methods: [{method: raw, label: \"'raw' it's\"}]\nmetrics: [ate]\n");
    ASSERT_EQ(run("run quote.yaml --out r").exit_code, 0);
  }
  CommandResult run(const std::string& arguments) { return loopbench_command(arguments, folder_); }
  std::string read(const std::string& name) { return read_all(folder_.path() / name); }
  TemporaryFolder folder_;
};

TEST_F(PlotCli, BlamesTheDiskIfTheDiskIsFull) {
  folder_.file("full.sh",
               "trap '' XFSZ\nulimit -f 0\n'" LOOPBENCH_BINARY "' plot r -o small --format svg");
  const std::string line = "cd '" + folder_.path().string() + "' && bash full.sh 2>&1 | cat >said";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string said = read("said");
  EXPECT_TRUE(has(said, "a temporary file, which cannot be written: File too large")) << said;
  EXPECT_FALSE(has(said, "Traceback")) << said;
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "small"));
}

TEST_F(PlotCli, DrawsLabelsThatBeginWithAQuote) {
  const CommandResult result = run("plot r -o quoted --format svg");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string drawn = read("quoted/01_room_1m_trajectories.svg");
  EXPECT_TRUE(has(drawn, "'raw' it's") || has(drawn, "&#39;raw&#39; it&#39;s")) << result.out;
}

TEST_F(PlotCli, WritesEveryFormatAndTheScriptThatDrawsIt) {
  folder_.file("my.mplstyle", "font.family: serif\naxes.edgecolor: blue\n");
  const CommandResult result =
      run("plot r -o f --format svg,pdf,png,pgf --panels plane --style my.mplstyle --labels 'My "
          "name_1' --script");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string stem = "f/01_room_1m_trajectories.";
  std::map<std::string, std::string> drawn;
  for (const char* const format : kFigureFormats) {
    drawn[stem + format] = read(stem + format);
    EXPECT_GT(drawn[stem + format].size(), 1000u) << format;
    EXPECT_TRUE(has(result.out, stem + format + "\n")) << result.out;
    std::filesystem::remove(folder_.path() / (stem + format));
  }
  EXPECT_TRUE(has(result.out, stem + "py\n")) << result.out;
  EXPECT_TRUE(has(drawn[stem + "svg"], ">My name_1<"));
  EXPECT_TRUE(has(drawn[stem + "svg"], "#0000ff"));
  const std::string script = "python3 '" + (folder_.path() / (stem + "py")).string() + "'";
  ASSERT_EQ(std::system((script + " 2>/dev/null || /usr/bin/" + script).c_str()), 0);
  for (const auto& [file, content] : drawn) EXPECT_EQ(read(file), content) << file;
  EXPECT_TRUE(has(run("plot r --style nothing").err, "'nothing' not found in the style library"));
}

TEST_F(PlotCli, StatesRepeatAndAlignment) {
  folder_.file("repeats.yaml",
               "datasets: [{dataset: simulated, keyframes: 40, label: a}]\nmethods: [raw]\n"
               "metrics: [ate]\nrepeats: 2\nprotocol: {align: sim3}\n");
  ASSERT_EQ(run("run repeats.yaml --out t").exit_code, 0);
  ASSERT_EQ(run("plot t -o f --panels plane --format svg").exit_code, 0);
  const std::string drawn = read("f/01_a_trajectories.svg");
  EXPECT_TRUE(has(drawn, ">a, repeat 0 (first of 2), sim3 alignment<"));
}

TEST_F(PlotCli, SelectsSequencesPanelsAndSize) {
  folder_.file("two.yaml",
               "datasets: [{dataset: simulated, keyframes: 40, label: 'off|ice_&%<b>'}, {dataset: "
               "simulated, keyframes: 40, label: b}]\nmethods: [raw, uniform]\nmetrics: [ate]\n");
  ASSERT_EQ(run("run two.yaml --out t").exit_code, 0);
  const CommandResult one =
      run("plot t -o f --methods raw,uniform --sequences b --panels xz,angle --size 3,2 --format "
          "svg --panel-columns 1");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, "f/02_b_trajectories.svg\nf/02_b_errors.svg\n");
  const std::string drawn = read("f/02_b_trajectories.svg");
  EXPECT_TRUE(has(drawn, "width=\"216pt\" height=\"")) << drawn.substr(0, 400);
  EXPECT_TRUE(has(drawn, "z [m]") && has(drawn, "uniform")) << drawn;
  EXPECT_TRUE(has(read("f/02_b_errors.svg"), "rotation error [deg]"));
  EXPECT_EQ(run("plot t -o g --panels x --format png").out,
            "g/01_off_ice_b_errors.png\ng/02_b_errors.png\n");
  EXPECT_TRUE(has(run("plot t --sequences c").err, "--sequences: no sequence is named 'c'"));
  EXPECT_TRUE(has(run("plot t --methods rwa").err, "did you mean 'raw'?"));
  EXPECT_EQ(run("plot t --panels zx").exit_code, 2);
  EXPECT_EQ(run("plot t --size 3").exit_code, 2);
}

TEST_F(PlotCli, DrawsScoresAndCostsOfAllSequences) {
  folder_.file("sizes.yaml",
               "datasets: [{dataset: simulated, sweep: {keyframes: [20, 40, 80]}}]\n"
               "methods: [raw, uniform]\nmetrics: [ate]\ntraces: false\n");
  ASSERT_EQ(run("run sizes.yaml --out t").exit_code, 0);
  const CommandResult all = run("plot t -o f --format svg");
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_TRUE(has(all.out, "f/ratio.svg\nf/time.svg\nf/boxes.svg\nf/growth.svg\n")) << all.out;
  EXPECT_TRUE(has(read("f/ratio.svg"), ">ratio to raw: ate rmse, dense<"));
  EXPECT_TRUE(has(read("f/growth.svg"), ">uniform: time O(n^"));
  EXPECT_EQ(run("plot t -o g --panels time,growth --format pgf --methods raw").out,
            "g/time.pgf\ng/growth.pgf\n");
  EXPECT_FALSE(has(read("g/growth.pgf"), "uniform"));
  EXPECT_EQ(run("plot r -o h --panels growth").exit_code, 2) << "one size";
}

TEST_F(PlotCli, SaysWhatStandsInItsWay) {
  const CommandResult taken = run("plot r -o quote.yaml");
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_EQ(taken.out, "");
  EXPECT_TRUE(has(taken.err, "cannot be written: Not a directory")) << taken.err;
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const CommandResult alone = run("plot r -o without");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_TRUE(has(alone.err, "python3 is not installed (package python3-matplotlib)")) << alone.err;
}

}  // namespace
}  // namespace loopbench::plot_cli_test
