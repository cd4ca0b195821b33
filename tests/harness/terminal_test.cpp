/// What the program prints on a terminal: width, colour, summary, help, lists.
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
    EXPECT_EQ(text.find("ate [m], dense, rmse by sequence\n"), 0u) << text;
    EXPECT_LE(widest_line(text), columns) << text;
    EXPECT_EQ(text.find('|'), std::string::npos) << text;
    EXPECT_NE(text.find("rank"), std::string::npos) << text;
    EXPECT_NE(text.find("\ntranslation ate, rmse [m], dense, "), std::string::npos) << text;
    EXPECT_NE(text.find(" x axis_error, rmse [m], dense, "), std::string::npos) << text;
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

TEST_F(OnATerminal, AnIncompleteLayoutIsOneTable) {
  folder_.file("c.yaml", kConfig);
  ASSERT_EQ(piped("run c.yaml").exit_code, 0);
  const auto tables = [](const std::string& text) {
    std::size_t out = 0;
    for (std::size_t at = 0; (at = text.find("\n| ---", at)) != std::string::npos; ++at) ++out;
    return out;
  };
  const std::string all = piped("table results/c --split ''").out;
  EXPECT_EQ(tables(all), 1u) << all;
  EXPECT_NE(all.find("times: dense (others: --where times=...)"), std::string::npos) << all;
  EXPECT_NE(piped("table results/c --split '' --where times=keyframes").out.find("| raw "),
            std::string::npos);
  const std::string rows = piped("table results/c --rows sequence").out;
  EXPECT_EQ(tables(rows), 1u) << rows;
  EXPECT_EQ(rows.find("| sequence [m] | "), 0u) << rows;
  EXPECT_NE(rows.find("score: ate (others: --show)"), std::string::npos) << rows;
  EXPECT_EQ(piped("table results/c --rows sequence --show gain").out.find("| sequence [%] | "), 0u);
  EXPECT_NE(piped("table results/c --split '' --plus-minus").out.find(" \u00b1 "),
            std::string::npos);
  const std::string latex = piped("table results/c --format latex --plus-minus").out;
  EXPECT_NE(latex.find("\\caption{ate, translation {[}m]}"), std::string::npos) << latex;
  EXPECT_NE(latex.find(" $\\pm$ "), std::string::npos) << latex;
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
  const std::string all = run("list").out;
  EXPECT_EQ(all.find("\n    planar = "), std::string::npos) << all;
  EXPECT_NE(all.find("\nsmoothing_spline "), std::string::npos);
  const std::string some = piped("list methods 'dm_n*'").out;
  EXPECT_EQ(some.find("dm_n3 "), 0u) << some;
  EXPECT_NE(some.find("\ndm_n5 "), std::string::npos);
  EXPECT_EQ(some.find("\ndm_m6"), std::string::npos);
  EXPECT_NE(some.find("\n    planar = 3"), std::string::npos);
  EXPECT_EQ(piped("list 'dm_n*'").out, some);
  EXPECT_NE(piped("list metrics --options").out.find("    delta = "), std::string::npos);
  EXPECT_NE(piped("list methods unifrom").err.find("did you mean 'uniform'?"), std::string::npos);
  EXPECT_EQ(piped("list methods 'zz*'").err, "loopbench: list: no name matches 'zz*'\n");
  EXPECT_EQ(piped("list zz raw").exit_code, 2);
  const std::string one = run("list uniform_open").out;  // its summary is longer than a line
  EXPECT_NE(one.find("\n" + std::string(24, ' ')), std::string::npos) << one;
}

TEST_F(OnATerminal, HelpHasExamplesForEachCommand) {
  const CommandResult alone = piped("");
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(alone.out, piped("help").out);
  EXPECT_NE(alone.out.find("Examples:\n  loopbench run "), std::string::npos) << alone.out;
  std::istringstream commands(
      "run,list,table,compare,check,eval,merge,submit,correct,export,traj,doctor,plot,report,"
      "traj crop");
  for (std::string command; std::getline(commands, command, ',');) {
    const CommandResult result = piped("help " + command);
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_NE(result.out.find("Examples:\n  loopbench "), std::string::npos) << command;
    EXPECT_EQ(result.out, piped(command + " --help").out) << command;
  }
  const std::string named = run("run --help", 80, "LOOPBENCH_NAME=./run.sh").out;
  EXPECT_NE(named.find("Usage: ./run.sh run [OPTIONS]"), std::string::npos) << named;
  EXPECT_NE(named.find("\n  ./run.sh run mine.yaml --dry-run\n"), std::string::npos) << named;
  EXPECT_EQ(named.find("  loopbench"), std::string::npos) << named;
  EXPECT_EQ(piped("help tabel").err,
            "loopbench: no command is named 'tabel'; did you mean 'table'?\n");
}

TEST_F(OnATerminal, HelpFits) {
  for (const char* command :
       {"", "run --help", "eval --help", "table --help", "traj crop --help"}) {
    const std::string narrow = run(command, 80).out;
    // Examples are printed in one line each, so that they can be copied.
    EXPECT_LE(widest_line(narrow.substr(0, narrow.find("Examples:"))), 80u) << narrow;
  }
}

}  // namespace
}  // namespace loopbench::terminal_test
