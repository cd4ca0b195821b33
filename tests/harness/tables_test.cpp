/// Which rows a table keeps, who is marked in it, and how it is written.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/error.hpp"
#include "harness/export/derived.hpp"
#include "harness/export/text.hpp"
#include "harness/export/where.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench {
namespace {

Record ate(const std::string& method, double rmse, int repeat = 0) {
  Record r;
  r.sequence = "room";
  r.repeat = repeat;
  r.method = method;
  r.protocol = "evo (align=se3, first=10)";
  r.times = "dense";
  r.metric = "ate";
  r.relation = "translation";
  r.axis = "3d";
  r.unit = "m";
  r.statistics.rmse = rmse;
  return r;
}

TEST(Where, KeepsWhatEveryRuleKeeps) {
  const auto keeps = [](const std::string& rule) { return where({rule})(ate("dm_n3", 1.0)); };
  EXPECT_TRUE(keeps("metric=ate"));
  EXPECT_FALSE(keeps("metric=rpe"));
  EXPECT_TRUE(keeps("metric!=rpe"));
  EXPECT_FALSE(keeps("metric!=ate"));
  const auto keeps_labelled = [](const std::string& rule) {
    Record r = ate("raw", 1.0);
    r.label = "error";
    return where({rule})(r);
  };
  EXPECT_TRUE(keeps_labelled("metric=ate"));  // name and label alike
  EXPECT_TRUE(keeps_labelled("metric=error"));
  EXPECT_TRUE(keeps_labelled("metric~^err"));
  EXPECT_FALSE(keeps_labelled("metric!=ate"));
  EXPECT_FALSE(keeps_labelled("metric!=error"));
  EXPECT_TRUE(keeps_labelled("label=error"));
  EXPECT_FALSE(keeps_labelled("label=ate"));
  EXPECT_TRUE(keeps("method~^dm_.[0-9]$"));
  EXPECT_FALSE(keeps("method~^raw"));
  EXPECT_TRUE(keeps("metric=ate,method~dm,times=dense"));
  EXPECT_FALSE(keeps("metric=ate,times=keyframes"));
  EXPECT_TRUE(keeps("protocol=evo (align=se3, first=10),metric=ate"));  // commas in brackets
  EXPECT_TRUE(keeps("method~^dm_n{1,2}3"));
  EXPECT_FALSE(where({"metric=ate", "times=keyframes"})(ate("raw", 1.0)));
  EXPECT_TRUE(where({})(ate("raw", 1.0)));
}

TEST(Where, KeepsTheReasonsOfCellsWithoutScores) {
  Record failed;
  failed.method = "raw";
  failed.status = "failed";
  EXPECT_TRUE(where({"metric=ate"})(failed));
  EXPECT_FALSE(where({"method=dm"})(failed));
  EXPECT_FALSE(where({"status=ok"})(failed));
}

TEST(Where, RefusesByName) {
  EXPECT_EQ(refusal_of([] { where({"metrc=ate"}); }),
            "where: 'metrc=ate': no column is named 'metrc'; did you mean 'metric'?");
  EXPECT_EQ(refusal_of([] { where({"ate"}); }),
            "where: 'ate' is not FIELD=TEXT, FIELD!=TEXT or FIELD~REGEX, for example metric=ate or "
            "method=\"a, b\"");
  EXPECT_EQ(refusal_of([] { where({"method~("}); }),
            "where: 'method~(': '(' is not a regular expression (missing ): ()");
  EXPECT_NE(refusal_of([] { where({"metric=ate,"}); }), "");
  EXPECT_NE(refusal_of([] { where({"metric!ate"}); }), "");
}

/// Each run's error is its number times the factor.
ByRun runs(double factor, int count = 8) {
  ByRun out;
  for (int i = 1; i <= count; ++i) out[std::to_string(i)] = factor * i;
  return out;
}

Marks marks(const std::vector<ByRun>& competitors,
            Better better = Better::lower,
            double alpha = 0.05) {
  return mark_best({competitors, {}, better, 0.0}, {.alpha = alpha});
}

TEST(MarkBest, MarksOnlyWhatIsProven) {
  const std::vector<ByRun> three{runs(2.0), runs(1.0), runs(3.0)};
  EXPECT_EQ(marks(three).marks, (std::vector<Mark>{Mark::second, Mark::best, Mark::none}));
  EXPECT_EQ(marks(three, Better::higher).marks,
            (std::vector<Mark>{Mark::second, Mark::none, Mark::best}));
  // 2^-7 twice is p = 0.0078 for each of three pairs: 0.023 after Holm.
  EXPECT_EQ(marks(three, Better::lower, 0.02).marks, (std::vector<Mark>(3, Mark::none)));
  // The two best cannot be told apart: no mark at all.
  ByRun alike = runs(1.0);
  alike["1"] = 1.01;
  EXPECT_EQ(marks({runs(1.0), alike, runs(3.0)}).marks, (std::vector<Mark>(3, Mark::none)));
}

TEST(MarkBest, ExplainsWhenNothingCanBeTested) {
  EXPECT_EQ(marks({runs(1.0, 5), runs(2.0, 5)}).why_none,
            "5 independent runs a cell cannot prove a difference at 0.05");
  EXPECT_EQ(marks({runs(1.0), {}}).why_none, "");  // no contest
}

TEST(MarkBest, NeverMarksACompetitorThatLacksARun) {
  ByRun lucky = runs(0.5);
  lucky.erase("8");
  EXPECT_EQ(marks({lucky, runs(1.0), runs(2.0)}).marks[0], Mark::none);
}

TEST(MarkBest, CountsFailuresAsLosses) {
  ByRun failing = runs(0.5, 10);
  for (int i = 1; i <= 6; ++i) failing[std::to_string(i)] = std::nullopt;
  EXPECT_EQ(marks({failing, runs(1.0, 10)}).marks, (std::vector<Mark>{Mark::none, Mark::none}));
  ByRun better = runs(0.5, 20);
  better["1"] = std::nullopt;  // one loss against nineteen wins
  EXPECT_EQ(marks({better, runs(1.0, 20)}).marks[0], Mark::best);
}

TEST(MarkBest, NeverMarksAMethodThatLosesNineteenOfTwenty) {
  ByRun loser;  // by a little on nineteen runs, and the one that it wins makes its mean the lowest
  for (int i = 1; i <= 20; ++i) loser[std::to_string(i)] = i == 20 ? 0.01 : 1.01 * i;
  EXPECT_NE(marks({loser, runs(1.0, 20)}).marks[0], Mark::best);
}

TEST(MarkBest, TakesRunsOfAGroupAsOne) {
  Lane lane{{runs(1.0), runs(2.0)}, {}, Better::lower, 0.0};
  EXPECT_EQ(mark_best(lane, {}).marks[0], Mark::best);
  for (int i = 1; i <= 8; ++i) lane.group[std::to_string(i)] = i < 5 ? "a" : "b";
  EXPECT_EQ(mark_best(lane, {}).marks[0], Mark::none);
  EXPECT_NE(mark_best(lane, {}).why_none, "");
}

std::vector<Table> marked() {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 8; ++repeat) {
    records.push_back(ate("a|b_&%<\"x\"\n_c", 0.1 + 0.01 * repeat, repeat));
    records.push_back(ate("raw", 1.0 + 0.01 * repeat, repeat));
    records.push_back(ate("dm_n3", 2.0 + 0.01 * repeat, repeat));
  }
  return pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}});
}

TEST(Formats, EscapeNamesAndMarkTheBest) {
  const std::vector<Table> tables = marked();
  const std::string notes =
      "marked: best, and second best, where it is proven better than all others, as compare "
      "tests "
      "it\n";
  EXPECT_EQ(markdown(tables),
            "### dense\n\n"
            "| method                  |   ate [m] |\n"
            "| ----------------------- | --------: |\n"
            "| a\\|b\\_&amp;%&lt;\"x\" \\_c | **0.135** |\n"
            "| raw                     |   _1.035_ |\n"
            "| dm_n3                   |     2.035 |\n\n"
            "- " +
                notes + "- each number is the mean of up to 8 cells\n");
  EXPECT_EQ(terminal(sheet(tables[0])),
            "dense\n"
            "method         ate [m]\n"
            "-------------  --------\n"
            "a|b_&%<\"x\" _c    0.135*\n"
            "raw              1.035+\n"
            "dm_n3            2.035\n" +
                notes + "each number is the mean of up to 8 cells\n");
  EXPECT_EQ(latex(sheet(tables[0])),
            "% dense\n"
            "\\begin{tabular}{lr}\n\\toprule\n"
            "method & ate {[}m] \\\\\n\\midrule\n"
            "a\\textbar{}b\\_\\&\\%\\textless{}\\textquotedbl{}x\\textquotedbl{} \\_c & "
            "\\textbf{0.135} \\\\\n"
            "raw & \\underline{1.035} \\\\\n"
            "dm\\_n3 & 2.035 \\\\\n"
            "\\bottomrule\n\\end{tabular}\n"
            "% " +
                notes + "% each number is the mean of up to 8 cells\n");
}

TEST(Formats, KeepNamesAndNumbersForMachines) {
  const std::string text = csv(marked());
  EXPECT_NE(text.find("\ndense,\"a|b_&%<\"\"x\"\"\n_c\",ate [m],0.135"), std::string::npos) << text;
  EXPECT_NE(text.find(",8,8,ok,best\n"), std::string::npos);
  const std::string object = json(marked());
  EXPECT_NE(object.find("\"a|b_&%<\\\"x\\\"\\n_c\""), std::string::npos) << object;
  EXPECT_NE(object.find("\"mark\": \"second\""), std::string::npos);
}

TEST(Pivot, MarksAlongRowsWhereTheColumnsAreMethods) {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 6; ++repeat) {
    records.push_back(ate("raw", 2.0, repeat));
    records.push_back(ate("dm", 1.0, repeat));
  }
  const TableSpec spec{
      .rows = {"metric"}, .columns = {"method"}, .split = {}, .show = {}, .where = {}};
  const std::vector<Table> tables = pivot(records, spec);
  ASSERT_EQ(tables[0].cells.size(), 1u);
  EXPECT_EQ(tables[0].cells[0][0].mark, Mark::none);
  EXPECT_EQ(tables[0].cells[0][1].mark, Mark::best);
  const std::vector<Table> sequences =
      pivot(records, TableSpec{.rows = {"sequence"}, .show = {}, .where = {}});
  EXPECT_EQ(sequences[0].cells[0][0].mark, Mark::none);  // sequences do not compete
  EXPECT_EQ(sequences[0].notes.size(), 1u);
}

TEST(Pivot, AveragesGainsByTheirRatios) {
  std::vector<Record> records;  // ratios 0.5 and 4: their geometric mean is sqrt 2
  for (int repeat = 0; repeat < 2; ++repeat) {
    records.push_back(ate("raw", 1.0, repeat));
    records.push_back(ate("dm", repeat == 0 ? 0.5 : 4.0, repeat));
  }
  for (const Record& gain : gains(records, "raw")) records.push_back(gain);
  const Table table = pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}}).at(0);
  EXPECT_NEAR(*table.cells[1][1].value, 100.0 * (1.0 - std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(*table.cells[0][1].value, 0.0);
  EXPECT_EQ(table.notes[0],
            "each number is the mean of up to 2 cells; gain is 1 - the geometric mean ratio to the "
            "baseline");
}

TEST(Pivot, StatesTheNumberOfRunsWhereAMethodFails) {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 4; ++repeat) {
    records.push_back(ate("raw", 1.5 + repeat, repeat));
    records.push_back(ate("dm", 1.0, repeat));
    if (repeat == 0) continue;
    records.back().status = "failed";
    records.back().metric.clear();
  }
  const std::vector<Table> tables =
      pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}});
  EXPECT_EQ(sheet(tables[0]).lines[0][1].text, "1.500");  // repeat 0, not 3.000
  EXPECT_EQ(sheet(tables[0]).lines[1][1].text, "1.000 (1 of 4)");
  EXPECT_EQ(tables[0].notes[0], "means over the 1 run that every method finished");
  EXPECT_NE(json(tables).find("\"averaged\": 1"), std::string::npos);
  EXPECT_NE(json(tables).find("\"possible\": 4"), std::string::npos);
  EXPECT_NE(csv(tables).find("dense,raw,ate [m],1.5,4,1,ok,"), std::string::npos) << csv(tables);
}

/// Errors by method and repeat; nan: the method failed there.
std::vector<Record> errors(const std::vector<std::pair<std::string, std::vector<double>>>& all) {
  std::vector<Record> out;
  for (const auto& [method, values] : all) {
    for (std::size_t repeat = 0; repeat < values.size(); ++repeat) {
      out.push_back(ate(method, values[repeat], static_cast<int>(repeat)));
      if (!std::isnan(values[repeat])) continue;
      out.back().status = "failed";
      out.back().metric.clear();
    }
  }
  return out;
}

Table table_of(const std::vector<Record>& records) {
  return pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}}).at(0);
}

TEST(Pivot, AveragesOverTheRunsThatEveryMethodFinished) {
  const double none = std::nan("");
  const Table table = table_of(errors({{"raw", {1.0, 2.0, 3.0, 40.0}},
                                       {"dm", {0.5, 1.5, 1.0, none}},
                                       {"gp", {none, 1.0, 4.0, 9.0}},
                                       {"bad", {none, none, none, none}}}));
  EXPECT_EQ(*table.cells[0][0].value, 2.5);  // repeats 1 and 2 only
  EXPECT_EQ(*table.cells[1][0].value, 1.25);
  EXPECT_EQ(*table.cells[2][0].value, 2.5);
  EXPECT_EQ(table.cells[0][0].averaged, 2u);
  EXPECT_EQ(table.cells[0][0].records, 4u);
  EXPECT_EQ(sheet(table).lines[2][1].text, "2.500 (3 of 4)");
  EXPECT_EQ(sheet(table).lines[3][1].text, "failed");  // and restricts nobody
  EXPECT_EQ(table.notes[1], "means over the 2 runs that every method finished");
}

TEST(Pivot, HasNoMeanWithoutACommonRun) {
  const double none = std::nan("");
  const Table table = table_of(errors({{"raw", {1.0, none}}, {"dm", {none, 2.0}}}));
  EXPECT_EQ(sheet(table).lines[0][1].text, "- (1 of 2)");
  EXPECT_EQ(sheet(table).lines[1][1].text, "- (1 of 2)");
  EXPECT_EQ(table.notes[0], "no means (-): no run is one that every method finished");
  EXPECT_NE(csv({table}).find("dense,raw,ate [m],,1,0,no common run,"), std::string::npos)
      << csv({table});
}

TEST(Pivot, AveragesGainsOverCommonRuns) {
  const double none = std::nan("");  // ratios 0.5 and 0.125 of dm, 2 of gp
  std::vector<Record> records =
      errors({{"raw", {1.0, 1.0, 1.0}}, {"dm", {0.5, 0.125, 7.0}}, {"gp", {2.0, 2.0, none}}});
  for (const Record& gain : gains(records, "raw")) records.push_back(gain);
  const Table table = table_of(records);
  EXPECT_NEAR(*table.cells[1][1].value, 75.0, 1e-12);
  EXPECT_NEAR(*table.cells[2][1].value, -100.0, 1e-12);
}

TEST(Pivot, ComparesOnlyCellsThatTriedTheSameRuns) {
  std::vector<Record> records =
      errors({{"raw", {1.0, 3.0}}, {"dm", {2.0, std::nan("")}}, {"gp", {5.0, 7.0}}});
  for (Record& r : records) {
    if (r.method == "gp") r.sequence = "hall";
  }
  const Table table = table_of(records);
  EXPECT_EQ(*table.cells[0][0].value, 1.0);
  EXPECT_EQ(*table.cells[2][0].value, 6.0);  // of another sequence
}

TEST(Formats, KeepLessOrEqualReadable) {
  EXPECT_NE(
      markdown(Sheet{"p <= 0.05, p < 1, <b>", {"a"}, {}, {}}).find("### p <= 0.05, p < 1, &lt;b>"),
      std::string::npos);
}

TEST(Pivot, MarksNothingAmongDescriptions) {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 6; ++repeat) {
    for (const char* method : {"raw", "dm"}) {
      records.push_back(ate(method, method[0] == 'r' ? 2.0 : 1.0, repeat));
      records.back().metric = "pairs";
      records.back().better = Better::neither;
    }
  }
  const std::vector<Table> tables = pivot(records, TableSpec{});
  for (const auto& row : tables[0].cells) EXPECT_EQ(row[0].mark, Mark::none);
}

}  // namespace
}  // namespace loopbench
