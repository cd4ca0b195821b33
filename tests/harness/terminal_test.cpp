/// Text for a terminal: width, colour, broken lines. The program on one: terminal_test.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "harness/answers/tables/table.hpp"
#include "harness/sweep/process/shell.hpp"
#include "harness/sweep/text/wrap.hpp"

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

TEST(Wrap, KeepsTextBesideOrBelowItsName) {
  EXPECT_EQ(beside("name", "one two three", 6, 13), "name  one two\n      three\n");
  EXPECT_EQ(beside("a name", "one two", 6, 0), "a name\n      one two\n");
}

}  // namespace
}  // namespace loopbench::terminal_test
