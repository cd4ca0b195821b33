/// What the program prints on a terminal: width, colour, summary, help, lists.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "harness/base/shell.hpp"
#include "harness/base/wrap.hpp"
#include "harness/tables/table.hpp"
#include "tests/support/command.hpp"

namespace loopbench::terminal_test {

using namespace harness;

namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t widest_line(const std::string& text) {
  std::istringstream in(text);
  std::size_t out = 0;
  for (std::string line; std::getline(in, line);) out = std::max(out, width(line));
  return out;
}

Table wide_table() {
  Table out{"a title of this table", {"method", "error x [m]", "error y [m]", "gain [%]"}, {}, {}};
  out.lines.push_back({{"uniform"}, {"0.723"}, {"0.850", true}, {"44.45"}});
  out.lines.push_back({{"raw"}, {"1.174"}, {"1.400"}, {"0.00"}});
  out.notes = {"a note that is longer than a narrow terminal"};
  return out;
}

TEST(Terminal, BreaksHeadingsAndThenColumnsToFit) {
  EXPECT_EQ(terminal(wide_table(), {38, false}),
            "a title of this table\n"
            "         error x  error y\n"
            "method       [m]      [m]   gain [%]\n"
            "-------  -------  --------  --------\n"
            "uniform    0.723    0.850*     44.45\n"
            "raw        1.174    1.400       0.00\n"
            "a note that is longer than a narrow\n"
            "  terminal\n");
}

TEST(Terminal, FitsAnyWidth) {
  for (const std::size_t columns : {40UL, 80UL, 120UL}) {
    Table view = wide_table();
    view.lines[0][0].text = "/a/long/path/to/the/runs/of/yesterday/estimate.txt";
    for (int i = 0; i < 6; ++i) {
      view.headings.push_back("another score [deg]");
      for (auto& line : view.lines) line.push_back({"123.456"});
    }
    const std::string text = terminal(view, {columns, false});
    EXPECT_LE(widest_line(text), columns) << text;
    EXPECT_NE(text.find("estimate.txt"), std::string::npos) << text;
  }
}

TEST(Terminal, ColoursTheBestOnly) {
  const std::string text = terminal(wide_table(), {80, true});
  EXPECT_NE(text.find("\033[1;32m0.850*\033[0m"), std::string::npos) << text;
  EXPECT_NE(text.find("\033[1ma title"), std::string::npos);
  EXPECT_EQ(terminal(wide_table()).find('\033'), std::string::npos);
}

TEST(Wrap, ShortensPathsAtTheirStartAndNamesInTheMiddle) {
  EXPECT_EQ(shortened("/long/path/to/a.txt", 12), "\u2026/to/a.txt");
  EXPECT_EQ(shortened("cubic_spline + smoothing", 11), "cubic\u2026thing");
  EXPECT_EQ(shortened("short", 11), "short");
  EXPECT_EQ(wrapped("one two three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrapped("moves 2.5 m, then", 9), (std::vector<std::string>{"moves", "2.5 m,", "then"}));
  EXPECT_EQ(cut("one two", 5), "one \u2026");
}

TEST(Shell, QuotesWhatAShellWouldExpand) {
  EXPECT_EQ(shell_quoted("results/a-1.b"), "results/a-1.b");
  EXPECT_EQ(shell_quoted("my run"), "'my run'");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_quoted(""), "''");
}

class OnATerminal : public testing::Test {
 protected:
  CommandResult run(const std::string& arguments,
                    std::size_t columns = 80,
                    const std::string& environment = "TERM=xterm") {
    return terminal_command(arguments, folder_, columns, environment);
  }
  CommandResult piped(const std::string& arguments) {
    return loopbench_command(arguments, folder_);
  }
  TemporaryFolder folder_;
};

const char* const kConfig =
    "datasets: [{dataset: simulated, label: a, keyframes: 40}, {dataset: simulated, label: b, "
    "path: office, keyframes: 40}]\n"
    "methods: [raw, uniform, uniform + cubic_spline]\nmetrics: [ate, axis_error]\nrepeats: 8\n";

TEST_F(OnATerminal, ErrorsAreBrokenAtWords) {
  const auto error = terminal_command("eval gt.txt a.txt --alignn se3", TemporaryFolder(), 60);
  EXPECT_EQ(error.exit_code, 2);
  EXPECT_EQ(error.out,
            "loopbench: no option of eval is named '--alignn'; did you\n"
            "  mean '--align'?\n"
            "Run with --help for more information.\n");
}

TEST_F(OnATerminal, RunEndsWithOneTableThatFits) {
  folder_.file("c.yaml", kConfig);
  ASSERT_EQ(piped("run c.yaml").exit_code, 0);
  for (const std::size_t columns : {80UL, 120UL}) {
    const std::string text = run("run c.yaml", columns, "TERM=dumb").out;
    EXPECT_EQ(text.find("dense, rmse, mean over 2 sequences\n"), 0u) << text;
    EXPECT_LE(widest_line(text), columns) << text;
    EXPECT_EQ(text.find('|'), std::string::npos) << text;
    EXPECT_LE(std::ranges::count(text, '\n'), 40) << text;
    EXPECT_NE(text.find("\nate, dense: uniform + cubic_spline is best, "), std::string::npos)
        << text;
    EXPECT_NE(text.find("\n= uniform + cubic_spline "), std::string::npos) << text;
    EXPECT_NE(text.find("  loopbench compare results/c "), std::string::npos) << text;
  }
  EXPECT_NE(
      run("run c.yaml", 80, "TERM=dumb LOOPBENCH_NAME=./run.sh").out.find("  ./run.sh table "),
      std::string::npos);
}

TEST_F(OnATerminal, TablesAreColouredUnlessTheUserObjects) {
  folder_.file("c.yaml", kConfig);
  ASSERT_EQ(piped("run c.yaml").exit_code, 0);
  const std::string colored = run("table results/c").out;
  EXPECT_NE(colored.find("\033[1m"), std::string::npos) << colored;
  EXPECT_EQ(run("table results/c", 80, "TERM=xterm NO_COLOR=1").out.find('\033'),
            std::string::npos);
  EXPECT_EQ(run("table results/c", 80, "TERM=dumb").out.find('\033'), std::string::npos);
  EXPECT_EQ(piped("table results/c").out.find("### a, keyframes"), 0u);
  EXPECT_EQ(piped("table results/c --format terminal").out.find('\033'), std::string::npos);
  EXPECT_LE(widest_line(run("compare results/c", 80, "TERM=dumb").out), 80u);
}

TEST(Wrap, KeepsTextBesideOrBelowItsName) {
  EXPECT_EQ(beside("name", "one two three", 6, 13), "name  one two\n      three\n");
  EXPECT_EQ(beside("a name", "one two", 6, 0), "a name\n      one two\n");
}

TEST_F(OnATerminal, ListsNameAndDescribeEachEntry) {
  for (const std::size_t columns : {60UL, 80UL}) {
    const std::string text = run("list", columns).out;
    EXPECT_LE(widest_line(text), columns) << text;
    EXPECT_EQ(text.find("\u2026"), std::string::npos) << "cut";
  }
  const std::string one = run("list uniform_open").out;  // its summary is longer than a line
  EXPECT_NE(one.find("\n" + std::string(24, ' ')), std::string::npos) << one;
}

TEST_F(OnATerminal, HelpNamesTheProgramAsTheUserDoes) {
  const std::string named = run("run --help", 80, "LOOPBENCH_NAME=./run.sh").out;
  EXPECT_THAT(named, HasSubstr("Usage: ./run.sh run [OPTIONS]"));
  EXPECT_THAT(named, HasSubstr("\n  ./run.sh run mine.yaml --dry-run\n"));
  EXPECT_THAT(named, Not(HasSubstr("  loopbench")));
}

TEST_F(OnATerminal, HelpFits) {
  for (const char* command :
       {"", "run --help", "eval --help", "table --help", "traj crop --help"}) {
    const std::string narrow = run(command, 80).out;
    // Examples are printed in one line each, so that they can be copied.
    EXPECT_LE(widest_line(narrow.substr(0, narrow.find("Examples:"))), 80u) << narrow;
  }
}

/// `eval` of gt.txt, a.txt and b.txt.
class EvalOnATerminal : public testing::Test {
 protected:
  EvalOnATerminal() {
    for (const auto& [from, to] :
         {std::pair{"gt", "gt"}, {"est_drift", "a"}, {"est_corrected", "b"}}) {
      std::filesystem::copy_file(std::string(LOOPBENCH_TEST_DATA "/golden/") + from + ".txt",
                                 folder_.path() / (std::string(to) + ".txt"));
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
  EXPECT_LE(widest_line(narrow.out), 80u) << narrow.out;
  EXPECT_THAT(narrow.out, HasSubstr("\na.txt "));
  EXPECT_THAT(narrow.out, HasSubstr(" coverage [%]\n"));
  EXPECT_THAT(narrow.out, Not(HasSubstr("diagnosis")));
  const CommandResult full = run("eval gt.txt a.txt --full", 80);
  EXPECT_LE(widest_line(full.out), 80u) << full.out;
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
    EXPECT_TRUE(is_example || width(line) <= 60) << line;
  }
}

TEST_F(EvalOnATerminal, SeveralEstimatesFitAndEndWithAVerdict) {
  for (const std::size_t columns : {80UL, 120UL}) {
    const std::string text = run("eval gt.txt a.txt b.txt", columns).out;
    EXPECT_LE(widest_line(text), columns) << text;
    EXPECT_THAT(text, Not(HasSubstr("|")));
    EXPECT_THAT(text, HasSubstr("\nate, keyframes: a 0.676 m, b 0.0406 m (-94 %). "));
  }
  const std::string piped = loopbench_command("eval gt.txt a.txt b.txt", folder_).out;
  EXPECT_THAT(piped, HasSubstr("\n| a.txt "));
  EXPECT_THAT(piped, HasSubstr(" (-94 %). One recording; a test needs 6.\n"));
  EXPECT_THAT(run("eval gt.txt a.txt b.txt --protocol evo,tum", 80).out,
              HasSubstr("\nate, keyframes, evo: a 12.7 m, b 11"));
}

}  // namespace
}  // namespace loopbench::terminal_test
