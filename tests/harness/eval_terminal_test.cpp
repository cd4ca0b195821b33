/// `eval` on a terminal, and its verdict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "datasets/formats/formats.hpp"
#include "harness/base/wrap.hpp"
#include "tests/support/command.hpp"
#include "tests/support/problems.hpp"

namespace loopbench::eval_terminal_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t widest(const std::string& text) {
  std::istringstream in(text);
  std::size_t out = 0;
  for (std::string line; std::getline(in, line);) out = std::max(out, harness::width(line));
  return out;
}

class EvalOnATerminal : public testing::Test {
 protected:
  EvalOnATerminal() {
    const Trajectory truth = test::hand_held_truth(60);
    write_tum(folder_.path() / "gt.txt", truth);
    for (const auto& [name, drift] : {std::pair{"a.txt", 0.002}, std::pair{"b.txt", 0.006}}) {
      const Problem problem =
          test::drifting(truth, twist({drift, 0, 0.001}, {0, 0, drift}), {{0, 50}});
      write_tum(folder_.path() / name, problem.keyframes);
    }
  }
  CommandResult run(const std::string& arguments, std::size_t columns) {
    return terminal_command(arguments, folder_, columns, "TERM=dumb");
  }
  TemporaryFolder folder_;
};

TEST_F(EvalOnATerminal, OneEstimateFits) {
  const CommandResult narrow = run("eval gt.txt a.txt", 80);
  EXPECT_EQ(narrow.exit_code, 0) << narrow.out;
  EXPECT_LE(widest(narrow.out), 80u) << narrow.out;
  EXPECT_THAT(narrow.out, HasSubstr("\na.txt "));
  EXPECT_THAT(narrow.out, HasSubstr(" coverage [%]\n"));
  EXPECT_THAT(narrow.out, Not(HasSubstr("diagnosis")));
  const CommandResult full = run("eval gt.txt a.txt --full", 80);
  EXPECT_LE(widest(full.out), 80u) << full.out;
  EXPECT_THAT(full.out, HasSubstr("\nscore "));
  EXPECT_THAT(full.out, HasSubstr("\ndiagnosis  matched "));
  EXPECT_THAT(full.out, HasSubstr("\nrpe 1 s x [m] "));
  const CommandResult wide = run("eval gt.txt a.txt", 160);
  EXPECT_EQ(wide.out, loopbench_command("eval gt.txt a.txt", folder_).out);
}

TEST_F(EvalOnATerminal, HelpBreaksListsOfChoices) {
  std::istringstream help(run("eval --help", 60).out);
  for (std::string line; std::getline(help, line);) {
    const bool is_example = line.starts_with("  loopbench ");
    EXPECT_TRUE(is_example || harness::width(line) <= 60) << line;
  }
}

TEST_F(EvalOnATerminal, HelpHasAtMostFiftyOptionsInGroups) {
  const std::string help = loopbench_command("eval --help", folder_).out;
  for (const char* const group : {"Files", "Pairing", "Alignment", "Metrics", "Output"}) {
    EXPECT_THAT(help, HasSubstr("\n\n" + std::string(group) + ":\n  -"));
  }
  std::size_t options = 0;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) options += line.starts_with("  -") ? 1 : 0;
  EXPECT_LE(options, 50u) << help;
  EXPECT_GT(options, 40u) << help;
}

TEST_F(EvalOnATerminal, ColumnsAreChosen) {
  const auto last = [&](const std::string& arguments) {
    const CommandResult result = loopbench_command("eval gt.txt a.txt " + arguments, folder_);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  EXPECT_THAT(last("--columns rpe_1_m,ate"),
              HasSubstr("\nestimate  rpe 1 m [m]  rpe 1 m [deg]  ate [m]  ate [deg]\n"));
  EXPECT_THAT(last("b.txt --columns 'coverage [%],ate [m]'"),
              HasSubstr("\n| estimate | coverage [%] | ate [m] |\n"));
  const std::string counts = "number of errors";  // of rpe, not of ate
  EXPECT_THAT(last("b.txt --columns rpe_1_m"), HasSubstr(counts));
  EXPECT_THAT(last("b.txt --columns ate"), testing::Not(HasSubstr(counts)));
  EXPECT_THAT(last("--metric ate --columns max,rmse"),
              HasSubstr("\nscore           max      rmse\n"));
  EXPECT_THAT(last("b.txt --full"), HasSubstr("\n- other statistics: --set statistic=max, --csv"));
  EXPECT_THAT(last("--csv --columns metric,unit"), testing::StartsWith("metric,unit\nate,m\n"));
  const auto error = [&](const std::string& arguments) {
    const CommandResult result = loopbench_command("eval gt.txt a.txt " + arguments, folder_);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(error("--metric ate --columns ate"),
              HasSubstr("--columns: no column is named 'ate' (known: rmse, mean, median"));
  EXPECT_THAT(error("--columns atee"), HasSubstr("did you mean 'ate'?"));
  EXPECT_THAT(error("--align simm3"), HasSubstr("; did you mean 'sim3'?"));
  EXPECT_THAT(error("--set statistc=rmse"), HasSubstr("; did you mean 'statistic'? (has: "));
  EXPECT_THAT(error("--common ye"), HasSubstr("did you mean 'yes'?"));
  EXPECT_THAT(error("--verbose"), testing::Not(HasSubstr("did you mean")));
  EXPECT_THAT(error("--ref x"), HasSubstr("'--ref' (known: --ref-format, --ref-body, "));
  EXPECT_THAT(error("--csv --columns metricc"), HasSubstr("did you mean 'metric'?"));
  EXPECT_EQ(error("--motion_filter -1 2"),
            "loopbench: eval: --motion_filter: -1 is not a number from 0 to 1000000000\n"
            "Run with --help for more information.\n");
  EXPECT_THAT(error("--json --columns ate"), HasSubstr("--columns excludes --json"));
}

TEST_F(EvalOnATerminal, ColumnsOfEstimatesThatAllFailedDoNotHideTheReason) {
  std::ofstream(folder_.path() / "far.txt") << "9000 0 0 0 0 0 0 1\n9001 1 0 0 0 0 0 1\n";
  const CommandResult result =
      loopbench_command("eval gt.txt far.txt far.txt --columns ate", folder_);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("matches the reference"));
}

TEST_F(EvalOnATerminal, SeveralEstimatesFitAndEndWithAVerdict) {
  for (const std::size_t columns : {80UL, 120UL}) {
    const std::string text = run("eval gt.txt a.txt b.txt", columns).out;
    EXPECT_LE(widest(text), columns) << text;
    EXPECT_THAT(text, Not(HasSubstr("|")));
    EXPECT_THAT(text,
                HasSubstr("\nverdict: translation ate, rmse [m], keyframes, loopbench: nothing "));
  }
  const std::string piped = loopbench_command("eval gt.txt a.txt b.txt", folder_).out;
  EXPECT_THAT(piped, HasSubstr("\n| a.txt "));
  EXPECT_THAT(piped, HasSubstr(" % above a, but 1 sequence cannot show a difference"));
  EXPECT_THAT(run("eval gt.txt a.txt b.txt --protocol evo,tum", 80).out,
              HasSubstr("\nverdict: translation ate, rmse [m], keyframes, evo: "));
}

}  // namespace
}  // namespace loopbench::eval_terminal_test
