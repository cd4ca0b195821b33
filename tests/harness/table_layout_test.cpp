/// Which tables `table` prints of several sequences, if no layout is given.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/command.hpp"

namespace loopbench::table_layout_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class TableLayout : public testing::Test {
 protected:
  /// Runs a sweep with sequences s1, s2, ...
  void run_sweep(int sequences) {
    std::string config = "datasets:\n";
    for (int i = 1; i <= sequences; ++i) {
      config += fmt::format(
          "  - {{dataset: simulated, label: s{}, path: room, keyframes: {}}}\n", i, 30 + i);
    }
    folder_.file("c.yaml", config + "methods: [raw, uniform]\nmetrics: [ate, axis_error]\n");
    ASSERT_EQ(loopbench_command("run c.yaml", folder_).exit_code, 0);
  }
  std::string table(const std::string& options) {
    const CommandResult result = loopbench_command("table results/c " + options, folder_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
  TemporaryFolder folder_;
};

std::size_t tables(const std::string& text) {
  std::size_t out = 0;
  for (std::size_t at = 0; (at = text.find("\n| ---", at)) != std::string::npos; ++at) ++out;
  return out;
}

TEST_F(TableLayout, HasAColumnForEachSequenceIfOneScoreIsShown) {
  run_sweep(12);
  const std::string one = table("--where metric=ate,unit=m,times=dense");
  EXPECT_THAT(one, StartsWith("### ate, translation, dense [m]\n\n| method  |     s1 |     s2 |"));
  EXPECT_THAT(one, HasSubstr("|    s12 |\n"));
  EXPECT_EQ(tables(one), 1u) << one;
  const std::string ate = table("--show ate");  // translation and rotation, keyframes and dense
  EXPECT_EQ(tables(ate), 4u) << ate;
  EXPECT_THAT(ate, HasSubstr("### ate, rotation, keyframes [deg]\n"));
  EXPECT_EQ(tables(table("--where metric=axis_error,times=dense")), 12u);  // three scores
  EXPECT_EQ(tables(table("--show ate --split sequence")), 12u);
  const std::string csv = table("--format csv --show gain --where times=dense");
  EXPECT_THAT(csv, HasSubstr("\n\"gain, translation, dense\",uniform,s12 [%],"));
}

TEST_F(TableLayout, StatesACommonUnitOnceOnATerminal) {
  run_sweep(2);
  EXPECT_THAT(table("--format terminal --columns sequence --split '' --where metric=ate,unit=m"),
              StartsWith("method [m]      s1      s2\n"));
}

TEST_F(TableLayout, IsForPapersTheFirstScoreBySequence) {
  run_sweep(12);
  const std::string latex = table("--format latex");
  EXPECT_THAT(latex, HasSubstr("\\caption{ate, translation {[}m]}\n"));
  EXPECT_THAT(latex, HasSubstr("\nmethod & s1 & s2 & s3 & s4 & s5 & s6 & s7 & s8 & s9 & s10"));
  EXPECT_THAT(latex, HasSubstr("\n% times: dense (others: --where times=...)\n"));
  EXPECT_EQ(latex.find("\\caption"), latex.rfind("\\caption"));
  EXPECT_THAT(table("--format latex --split sequence --show ate,gain,time"),
              HasSubstr("\nmethod & ate {[}m] & ate {[}deg] & gain {[}\\%] & time {[}ms] \\\\\n"));
}

TEST_F(TableLayout, IsForPapersTheFirstScoreGainAndTimeOfOneSequence) {
  run_sweep(1);
  EXPECT_THAT(table("--format latex"),
              HasSubstr("\nmethod & ate {[}m] & ate {[}deg] & gain {[}\\%] & time {[}ms] \\\\\n"));
  EXPECT_THAT(table("--show ate"), StartsWith("### s1, keyframes\n"));
  const CommandResult slip = loopbench_command("table results/c --show atte", folder_);
  EXPECT_EQ(slip.err, "loopbench: --show: no score is named 'atte'; did you mean 'ate'?\n");
}

TEST_F(TableLayout, HasARowForEachOfManySequences) {
  run_sweep(13);
  const std::string latex = table("--format markdown");
  EXPECT_THAT(latex, HasSubstr("| sequence |    raw | uniform |\n"));
  EXPECT_THAT(latex, HasSubstr("\n| s13 "));
  EXPECT_EQ(tables(latex), 1u) << latex;
}

}  // namespace
}  // namespace loopbench::table_layout_test
