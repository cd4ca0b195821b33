/// Output formats of tables. Filters: where_test.cpp, averages: pivot_test.cpp, marks:
/// mark_best_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/answers/tables/pivot.hpp"
#include "harness/answers/tables/reasons.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "harness/answers/tables/summary.hpp"
#include "harness/sweep/model/where.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::tables_test {
namespace {

std::vector<Table> marked() {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 8; ++repeat) {
    records.push_back(ate("a|b_&%<\"x\"\n_c", 0.1 + 0.01 * repeat, repeat));
    records.push_back(ate("raw", 1.0 + 0.01 * repeat, repeat));
    records.push_back(ate("dm_n3", 2.0 + 0.01 * repeat, repeat));
  }
  return pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}});
}

TEST(Formats, MarkdownHasNoLinksAndImagesOfNames) {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 8; ++repeat) {
    records.push_back(ate("![x](http://e/x.png)", 0.1, repeat));
    records.push_back(ate("[a] (b)", 0.2, repeat));
  }
  const std::string text =
      markdown(pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}}));
  EXPECT_NE(text.find("| ![x\\](http://e/x.png) |"), std::string::npos) << text;
  EXPECT_NE(text.find("| [a] (b) "), std::string::npos) << text;
  EXPECT_EQ(text.find("[x]("), std::string::npos) << text;
}

TEST(Formats, LinesOfANoteBeginNoListAndNoQuote) {
  Table table{"", {}, {}, {"aaaaaaaaa + bbbbbbbb > cccccccc - 3 # -37"}};
  table.note_width = 10;
  EXPECT_EQ(markdown(table), "- aaaaaaaaa\n  \\+ bbbbbbbb\n  \\> cccccccc\n  \\- 3 # -37\n");
}

TEST(Formats, LatexHasTheSentenceOfATableWithoutColumns) {
  EXPECT_EQ(latex(Table{"a_b: 5 %", {}, {}, {"c"}}),
            "\\noindent a\\_\\allowbreak{}b: 5 \\%\\par\nc\\par\n");
}

TEST(Formats, EscapeNamesAndMarkTheBest) {
  const std::vector<Table> tables = marked();
  const std::string notes = "marked: shown to be better than each other method of the column\n";
  EXPECT_EQ(markdown(tables),
            "### dense\n\n"
            "| method             |   ate [m] |\n"
            "| ------------------ | --------: |\n"
            "| a\\|b\\_\\&%\\<\"x\" \\_c | **0.135** |\n"
            "| raw                |     1.035 |\n"
            "| dm_n3              |     2.035 |\n\n"
            "- " +
                notes + "- each number is the mean of up to 8 cells\n");
  EXPECT_EQ(terminal(tables[0]),
            "dense\n"
            "method         ate [m]\n"
            "-------------  --------\n"
            "a|b_&%<\"x\" _c    0.135*\n"
            "raw              1.035\n"
            "dm_n3            2.035\n" +
                notes + "each number is the mean of up to 8 cells\n");
  const std::string paper = latex(tables[0], {.wide = true});
  for (const char* const part :
       {"\\begin{table*}\n",
        "\\caption{dense; rmse; times: dense; runs per number: at most 8}",
        "\\begin{tabular}{@{}lr@{}}\n\\toprule\nmethod & ate {[}m] \\\\\n\\midrule\n"
        "a\\textbar{}b\\_\\allowbreak{}\\&\\%\\textless{}\\char34{}x\\char34{} \\_\\allowbreak{}c "
        "& "
        "\\textbf{0.135} \\\\\nraw & 1.035 \\\\\n",
        "marked: shown to be better than each other method of the column\\par\n"}) {
    EXPECT_NE(paper.find(part), std::string::npos) << part << paper;
  }
}

/// So many rows and columns of numbers, with long headings.
Table numbers(int rows, int columns) {
  Table out{"wide", {"method"}, {}, {}};
  out.notes = {"a--b: failed (no --file)",
               {"times: dense (others: --where times=...)", "times: dense"}};
  for (int column = 0; column < columns; ++column)
    out.headings.push_back("score " + std::to_string(column) + " [deg]");
  out.units.assign(out.headings.size(), "deg");
  out.units[0] = "";
  for (int row = 0; row < rows; ++row) {
    out.lines.push_back({"method " + std::to_string(row)});
    for (int column = 0; column < columns; ++column) out.lines.back().emplace_back("0.1234");
  }
  return out;
}

std::size_t occurrences(const std::string& text, const std::string& what) {
  std::size_t out = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++out;
  return out;
}

TEST(Formats, LatexIsOneTableThatIsTransposedIfItIsTooWide) {
  const std::string upright = latex(numbers(9, 3));
  EXPECT_EQ(occurrences(upright, "\\begin{table}"), 1U);
  EXPECT_EQ(occurrences(upright, "\nmethod 8 & 0.1234"), 1U) << upright;
  const std::string text = latex(numbers(3, 7));
  EXPECT_EQ(occurrences(text, "\\begin{table}"), 1U);
  EXPECT_EQ(occurrences(text, "\n & method 0 & method 1 & method 2 \\\\"), 1U) << text;
  EXPECT_EQ(occurrences(text, "\nscore 6 & 0.1234"), 1U) << text;
  const std::string wide = latex(numbers(16, 8));
  EXPECT_EQ(occurrences(wide, "\\begin{table*}"), 1U) << wide;
  EXPECT_EQ(occurrences(wide, "\nmethod 15 & 0.1234"), 1U);
  const std::string huge = latex(numbers(40, 40));
  EXPECT_GT(occurrences(huge, "\\begin{table}"), 3U);
  EXPECT_EQ(occurrences(huge, "(part 1 of"), 1U);
}

TEST(Formats, LatexHasTheNotesForPapers) {
  const std::string text = latex(numbers(3, 3));
  EXPECT_EQ(occurrences(text, "a{-}{-}b: failed (no {-}{-}file)\\par"), 1U) << text;  // no remark
  EXPECT_EQ(occurrences(text, "times: dense\\par"), 1U) << text;
  EXPECT_EQ(occurrences(text, "where"), 0U) << text;
}

TEST(Formats, LatexHasACaptionAndALabel) {
  const std::string text =
      latex(numbers(2, 2), {.caption = "Errors of $N$ runs", .label = "tab:errors"});
  EXPECT_EQ(occurrences(text, "\\caption{Errors of $N$ runs}\\label{tab:errors}"), 1U) << text;
  EXPECT_EQ(occurrences(text, "\nwide {[}deg]\\par"), 1U) << text;
}

TEST(Formats, LatexExplainsEqualNumbersOfWhichOneIsBold) {
  Table table = numbers(3, 2);
  table.marks = {true, 1};
  table.notes = {marks_text(*table.marks)};
  table.lines[0][1].is_best = true;
  const std::string text = latex(table);
  EXPECT_EQ(occurrences(text, "\\textbf{0.1234} & 0.1234 "), 1U) << text;
  EXPECT_EQ(occurrences(text, "& 0.1234$^\\dagger$ & 0.1234 "), 2U) << text;
  EXPECT_EQ(occurrences(text, "$^\\dagger$: shown to be worse than an equally printed bold number"),
            1U)
      << text;
}

TEST(Formats, StateACommonUnitOnce) {
  Table table{"dense", {"method", "room [m]", "hall [m]"}, {{"raw", "1", "2"}}, {}};
  table.units = {"", "m", "m"};
  EXPECT_NE(latex(table).find("\\caption{dense {[}m]}"), std::string::npos) << latex(table);
  EXPECT_NE(latex(table).find("\nmethod & room & hall \\\\\n"), std::string::npos) << latex(table);
  table.title.clear();
  EXPECT_NE(markdown(table).find("| method [m] | room | hall |\n"), std::string::npos)
      << markdown(table);
  table.headings[2] = "hall [deg]";
  table.units[2] = "deg";
  EXPECT_NE(markdown(table).find("| method | room [m] | hall [deg] |\n"), std::string::npos);
}

TEST(Formats, TakeNothingInANameForAUnitOrAMark) {
  Table table{"", {"method", "room [m]", "hall [m]"}, {{"raw", "1", "1"}}, {}};
  table.notes = {"marked: the second row"};
  table.lines[0][1].is_best = true;
  EXPECT_NE(markdown(table).find("| method | room [m] | hall [m] |\n"), std::string::npos)
      << markdown(table);
  EXPECT_EQ(latex(table).find("dagger"), std::string::npos) << latex(table);
  EXPECT_NE(latex(table).find("marked: the second row"), std::string::npos) << latex(table);
}

TEST(Formats, LatexStatesWhatIsMarkedOfATransposedTable) {
  Table table = numbers(3, 7);
  table.marks = {true, 7};
  table.notes = {marks_text(*table.marks), "a column"};
  table.lines[0][1].is_best = true;
  const std::string text = latex(table);
  EXPECT_EQ(occurrences(text, "each other method of the row, corrected for 7 rows"), 1U) << text;
  EXPECT_EQ(occurrences(text, "a column"), 1U) << text;
}

TEST(Formats, KeepNamesAndNumbersForMachines) {
  const std::string text = csv(marked());
  EXPECT_NE(text.find("\ndense,\"a|b_&%<\"\"x\"\"\n_c\",ate [m],0.135"), std::string::npos) << text;
  EXPECT_NE(text.find(",8,8,ok,best\n"), std::string::npos);
  const std::string object = json(marked());
  EXPECT_NE(object.find("\"a|b_&%<\\\"x\\\"\\n_c\""), std::string::npos) << object;
  EXPECT_NE(object.find("\"mark\": \"best\""), std::string::npos);
}

TEST(Formats, KeepLessOrEqualReadable) {
  EXPECT_NE(
      markdown(Table{"p <= 0.05, p < 1, <b>", {"a"}, {}, {}}).find("### p <= 0.05, p < 1, \\<b>"),
      std::string::npos);
}

TEST(Formats, StateReasonsForMissingValues) {
  std::vector<Record> records{ate("raw", 0.25), ate("bad", 0.0)};
  records[1].kind.edit().metric.clear();
  records[1].status = Status::failed;
  records[1].why = "no such luck";
  const std::string text = markdown(pivot(records, TableSpec{}));
  EXPECT_NE(text.find("| bad    |  failed |\n\n- bad: failed: no such luck\n"), std::string::npos)
      << text;
}

TEST(Notes, SayAReasonOnce) {
  EXPECT_EQ(
      grouped({{"raw", "ate rotation", "declined", "no attitude"},
               {"raw", "rpe rotation", "declined", "no attitude"},
               {"raw", "ate rotation", "declined", "no attitude"},
               {"raw", "closure_residual", "declined", "no closures"},
               {"bad", "", "failed", "no luck"},
               {"uniform", "ate rotation", "declined", "no attitude"},
               {"uniform", "rpe rotation", "declined", "no attitude"},
               {"uniform", "closure_residual", "failed", "no closures"}}),
      (std::vector<std::string>{"raw, uniform: ate rotation, rpe rotation declined: no attitude",
                                "raw: closure_residual declined: no closures",
                                "bad: failed: no luck",
                                "uniform: closure_residual failed: no closures"}));
}

TEST(Csv, QuotesAndKeepsFullPrecision) {
  std::vector<Record> records{ate("a, \"b\"", 0.1)};
  const std::string text = csv(records);
  EXPECT_NE(text.find("\nroom,0,\"a, "
                      "\"\"b\"\"\",,false,false,\"evo (align=se3, "
                      "first=10)\",,dense,ate,ate,translation,3d,m,lower,,0,0.1,"),
            std::string::npos)
      << text;
  records[0].statistics.rmse = 1.0 / 3.0;
  EXPECT_NE(csv(pivot(records, TableSpec{})).find("0.3333333333333333"), std::string::npos);
}

TEST(Decimals, KeepFourSignificantDigitsOfTheLargest) {
  EXPECT_EQ(decimals(0.109), 4);
  EXPECT_EQ(decimals(9.9), 3);
  EXPECT_EQ(decimals(31.5), 2);
  EXPECT_EQ(decimals(31500.0), 1);
  EXPECT_EQ(decimals(0.0), 4);
  EXPECT_EQ(decimals(0.00123), 4);
  EXPECT_EQ(fixed(0.00017612, decimals(0.00017612)), "0.000176");
  EXPECT_EQ(decimals(1e-8), 4) << "rounding errors";
  EXPECT_EQ(fixed(-1e-9, 4), "0.0000");
}

std::vector<Record> two_methods() {
  std::vector<Record> out;
  for (const char* method : {"raw", "dm"}) {
    out.push_back(ate(method, 1.0));
    out.back().statistics.count = method == std::string("dm") ? 300 : 400;
    out.back().cell.edit().oracle_closures = true;
  }
  return out;
}

TEST(Summary, MarksOracleClosures) {
  const std::vector<std::string> notes =
      note_texts(summary(two_methods(), {"raw", "rmse", {}}).front());
  EXPECT_EQ(std::ranges::count(
                notes, "closures are oracle, measured in the reference or selected by it: room"),
            1);
}

TEST(Summary, HasNoVerdictOnCounts) {
  const auto of = [](const std::string& value) {
    return summary(two_methods(), {"raw", value, {}});
  };
  EXPECT_EQ(of("rmse").size(), 2u);
  EXPECT_EQ(of("count").size(), 1u);
  EXPECT_EQ(of("sse").front().title, "dense, sse, mean over the runs of room");
}

}  // namespace
}  // namespace loopbench::compared_sweep::tables_test
