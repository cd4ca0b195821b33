/// `plot` as a process: a full disk and awkward labels.
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::plot_cli_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class PlotCli : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "needs gnuplot";
    folder_.file("quote.yaml",
                 "datasets: [{dataset: simulated, keyframes: 40, label: \"'room\\e[1m'\"}]\n"
                 "methods: [{method: raw, label: \"'raw' it's\"}]\nmetrics: [ate]\n");
    ASSERT_EQ(run("run quote.yaml --out r").exit_code, 0);
  }
  CommandResult run(const std::string& arguments) { return loopbench_command(arguments, folder_); }
  std::string read(const std::string& name) { return read_all(folder_.path() / name); }
  TemporaryFolder folder_;
};

TEST_F(PlotCli, BlamesTheDiskAndNotGnuplotIfTheDiskIsFull) {
  folder_.file("full.sh",
               "trap '' XFSZ\nulimit -f 0\n'" LOOPBENCH_BINARY "' plot r -o small --format svg");
  const std::string line = "cd '" + folder_.path().string() + "' && bash full.sh 2>&1 | cat >said";
  ASSERT_EQ(std::system(line.c_str()), 0);
  const std::string said = read("said");
  EXPECT_TRUE(has(said, ".svg: cannot be written: File too large")) << said;
  EXPECT_FALSE(has(said, "gnuplot")) << said;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "small"));
}

TEST_F(PlotCli, DrawsLabelsThatBeginWithAQuote) {
  const CommandResult result = run("plot r -o quoted --format svg");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string drawn = read("quoted/01_room_1m_trajectories.svg");
  EXPECT_TRUE(has(drawn, "'raw' it's") || has(drawn, "&#39;raw&#39; it&#39;s")) << result.out;
}

}  // namespace
}  // namespace loopbench::plot_cli_test
