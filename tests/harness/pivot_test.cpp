/// What a table averages, over which runs, and which notes say so.
#include "harness/answers/tables/pivot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/core/error.hpp"
#include "harness/answers/compare/derived.hpp"
#include "harness/answers/tables/record_csv.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::pivot_test {
namespace {

const double kNone = std::nan("");

/// Errors by method and repeat; nan: the method failed there.
std::vector<Record> errors(const std::vector<std::pair<std::string, std::vector<double>>>& all) {
  std::vector<Record> out;
  for (const auto& [method, values] : all) {
    for (std::size_t repeat = 0; repeat < values.size(); ++repeat) {
      out.push_back(ate(method, values[repeat], static_cast<int>(repeat)));
      if (!std::isnan(values[repeat])) continue;
      out.back().status = Status::failed;
      out.back().kind.edit().metric.clear();
    }
  }
  return out;
}

/// Adds the gains over raw.
std::vector<Record> with_gains(std::vector<Record> records) {
  for (const Record& gain : gains(records, "raw")) records.push_back(gain);
  return records;
}

Table table_of(const std::vector<Record>& records) {
  return pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}}).at(0);
}

TEST(Pivot, MarksNoStatisticWithoutADirection) {
  std::vector<Record> records;
  for (int repeat = 0; repeat < 8; ++repeat) {
    for (const double error : {2.0, 1.0}) {
      Record r = ate(error > 1.5 ? "raw" : "dm", error, repeat);
      r.statistics.sse = error * error;
      r.statistics.count = error > 1.5 ? 400 : 300;
      r.kind.edit().unit = "m";
      records.push_back(r);
      r.kind.edit().relation = "rotation";
      r.kind.edit().unit = "deg";
      records.push_back(r);
    }
  }
  const auto table = [&](const std::string& value) {
    const TableSpec spec{
        .columns = {"score"}, .split = {}, .value = value, .show = {}, .where = {}};
    return pivot(records, spec).at(0);
  };
  EXPECT_TRUE(table("rmse").lines[1][1].is_best);
  for (const std::string value : {"sse", "count"}) {
    for (const auto& line : table(value).lines) {
      for (const TableCell& cell : line) EXPECT_FALSE(cell.is_best) << value;
    }
  }
  EXPECT_EQ(table("sse").headings,
            (std::vector<std::string>{"method", "ate [m^2]", "ate [deg^2]"}));
  EXPECT_EQ(table("count").headings, (std::vector<std::string>{"method", "ate", "ate rotation"}));
}

TEST(Pivot, ListsAFailureOnlyUnderItsOwnSequence) {
  std::vector<Record> records{ate("dm", 0.0)};
  records[0].cell.edit().sequence = "a";
  records[0].status = Status::failed;
  records[0].kind.edit().metric.clear();
  records[0].kind.edit().times.clear();
  for (const std::string sequence : {"a", "a2", "a, b"}) {
    records.push_back(ate("raw", 1.0));
    records.back().cell.edit().sequence = sequence;
  }
  const std::vector<Table> tables = pivot(records, TableSpec{.show = {}, .where = {}});
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].lines.size(), 2u);
  ASSERT_EQ(tables[1].lines.size(), 1u);
  EXPECT_EQ(tables[1].lines[0][0].text, "raw");
  ASSERT_EQ(tables[2].lines.size(), 1u);
  EXPECT_EQ(tables[2].lines[0][0].text, "raw");
}

TEST(Pivot, AveragesOverTheRunsThatEveryMethodFinished) {
  const std::vector<Table> tables{table_of(errors({{"raw", {1.0, 2.0, 3.0, 40.0}},
                                                   {"dm", {0.5, 1.5, 1.0, kNone}},
                                                   {"gp", {kNone, 1.0, 4.0, 9.0}},
                                                   {"bad", {kNone, kNone, kNone, kNone}}}))};
  const Table& table = tables[0];
  EXPECT_EQ(*table.lines[0][1].value, 2.5);  // repeats 1 and 2 only
  EXPECT_EQ(*table.lines[1][1].value, 1.25);
  EXPECT_EQ(*table.lines[2][1].value, 2.5);
  EXPECT_EQ(table.lines[0][1].averaged, 2u);
  EXPECT_EQ(table.lines[0][1].records, 4u);
  EXPECT_EQ(table.lines[2][1].text, "2.500 (3 of 4)");
  EXPECT_EQ(table.lines[3][1].text, "failed");  // and restricts nobody
  EXPECT_EQ(table.notes[1], "means over the 2 runs that every method finished");
  EXPECT_NE(json(tables).find("\"averaged\": 2"), std::string::npos);
  EXPECT_NE(json(tables).find("\"possible\": 4"), std::string::npos);
  EXPECT_NE(csv(tables).find("dense,raw,ate [m],2.5,4,2,ok,"), std::string::npos) << csv(tables);
}

/// Sequences of two runs and one: the weights are 1/4, 1/4 and 1/2.
TEST(Pivot, DeviationsHaveTheWeightsOfTheMean) {
  std::vector<Record> records{ate("raw", 1.0, 0), ate("raw", 3.0, 1), ate("raw", 5.0, 0)};
  records[2].cell.edit().sequence = "other";
  const auto cell = [&] {
    TableSpec spec{.split = {"times"}, .show = {}, .where = {}};
    spec.plus_minus = true;
    return pivot(records, spec).at(0).lines.at(0).at(1);
  };
  EXPECT_NEAR(*cell().value, 3.5, 1e-12);
  EXPECT_NEAR(cell().effective, 16.0 / 6.0, 1e-12);
  EXPECT_NEAR(*cell().deviation, std::sqrt(2.75 / 0.625), 1e-12);
  records.push_back(ate("raw", 7.0, 1));
  records[3].cell.edit().sequence = "other";
  EXPECT_NEAR(*cell().value, 4.0, 1e-12);
  EXPECT_NEAR(cell().effective, 4.0, 1e-12);
  EXPECT_NEAR(*cell().deviation, std::sqrt(20.0 / 3.0), 1e-12);
}

TEST(Pivot, HasNoMeanWithoutACommonRun) {
  const Table table = table_of(errors({{"raw", {1.0, kNone}}, {"dm", {kNone, 2.0}}}));
  EXPECT_EQ(table.lines[0][1].text, "- (1 of 2)");
  EXPECT_EQ(table.lines[1][1].text, "- (1 of 2)");
  EXPECT_EQ(table.notes[0], "no means (-): no run was finished by every method");
  EXPECT_NE(csv({table}).find("dense,raw,ate [m],,1,0,no common run,"), std::string::npos)
      << csv({table});
}

TEST(Pivot, AveragesGainsOverCommonRuns) {
  // ratios 0.5 and 0.125 of dm, 2 of gp
  const Table table = table_of(with_gains(
      errors({{"raw", {1.0, 1.0, 1.0}}, {"dm", {0.5, 0.125, 7.0}}, {"gp", {2.0, 2.0, kNone}}})));
  EXPECT_EQ(*table.lines[0][2].value, 0.0);
  EXPECT_NEAR(*table.lines[1][2].value, 75.0, 1e-12);
  EXPECT_NEAR(*table.lines[2][2].value, -100.0, 1e-12);
  EXPECT_EQ(table.notes[0],
            "each number is the mean of up to 2 cells; gain is 1 - the geometric mean ratio to the "
            "baseline");
}

TEST(Pivot, AveragesChangesAsVerdictsDo) {
  std::vector<Record> records =
      errors({{"raw", {1.0, 1.0}}, {"dm", {0.5, 0.125}}, {"gp", {2.0, 2.0}}});
  for (const Record& change : changes(records, "raw")) records.push_back(change);
  const Table table = table_of(records);
  EXPECT_EQ(table.headings[2], "change [%]");
  EXPECT_FALSE(std::signbit(*table.lines[0][2].value));  // 0, not -0
  EXPECT_NEAR(*table.lines[1][2].value, -75.0, 1e-12);
  EXPECT_NEAR(*table.lines[2][2].value, 100.0, 1e-12);
  EXPECT_EQ(table.notes[0],
            "each number is the mean of up to 2 cells; change is the geometric mean ratio to the "
            "baseline - 1");
}

TEST(Pivot, ComparesOnlyCellsThatTriedTheSameRuns) {
  std::vector<Record> records =
      errors({{"raw", {1.0, 3.0}}, {"dm", {2.0, kNone}}, {"gp", {5.0, 7.0}}});
  for (Record& r : records) {
    if (r.cell->method == "gp") r.cell.edit().sequence = "hall";
  }
  const Table table = table_of(records);
  EXPECT_EQ(*table.lines[0][1].value, 1.0);
  EXPECT_EQ(*table.lines[2][1].value, 6.0);  // of another sequence
}

TEST(Gain, IsMeasuredFromTheBaselineOfTheSameTimes) {
  std::vector<Record> records{
      ate("raw", 0.2), ate("uniform", 0.05), ate("raw", 0.4), ate("uniform", 0.5)};
  records[2].kind.edit().times = records[3].kind.edit().times = "keyframes";
  const std::vector<Record> g = gains(records, "raw");
  ASSERT_EQ(g.size(), 4u);
  EXPECT_DOUBLE_EQ(g[0].statistics.rmse, 0.0);
  EXPECT_DOUBLE_EQ(g[1].statistics.rmse, 75.0);
  EXPECT_DOUBLE_EQ(g[3].statistics.rmse, -25.0);  // worse is negative
  EXPECT_EQ(g[3].kind->unit, "%");
  EXPECT_TRUE(gains({ate("raw", 0.2)}, "").empty());
}

TEST(Gain, IsDeclinedWhereTheBaselineIsPerfect) {
  const std::vector<Record> g = gains({ate("raw", 1e-16), ate("uniform", 0.15)}, "raw");
  EXPECT_EQ(g[1].status, Status::declined);
  EXPECT_EQ(g[1].why, "the error of the baseline raw is zero");
}

TEST(RunTimes, AreOnePerCellAndTimes) {
  std::vector<Record> records{ate("raw", 0.2), ate("raw", 0.1), ate("bad", 0.0)};
  records[2].status = Status::failed;
  records[1].kind.edit().axis = "x";
  for (Record& r : records) {
    r.cell.edit().runs = 1;
    r.cell.edit().seconds = 0.0025;
  }
  const std::vector<Record> t = run_times(records);
  ASSERT_EQ(t.size(), 1u);
  EXPECT_EQ(t[0].statistics.rmse, 2.5);
  EXPECT_EQ(t[0].kind->unit, "ms");

  // Other costs are scores only if a filter or a list asks for them.
  EXPECT_TRUE(cost_scores(records, {"ate", "method=cpu"}).empty());
  EXPECT_TRUE(cost_scores(records, {"cpu"}).empty());  // unknown
  for (Record& r : records) {
    r.cell.edit().cpu_seconds = 0.002;
    r.cell.edit().peak_memory = 3'000'000;
  }
  const std::vector<Record> costs = cost_scores(records, {"cpu", "metric=memory_mb,times=dense"});
  EXPECT_TRUE(cost_scores(records, {"method=my cpu_ms", "sequence~memory_mb"}).empty());
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_EQ(costs[0].kind->label + " " + costs[1].kind->label, "cpu memory");
  EXPECT_EQ(costs[0].statistics.rmse, 2.0);
  EXPECT_EQ(costs[1].statistics.max, 3.0);
}

TEST(Pivot, LeavesIncompleteNumbersOutAndSaysSoOnce) {
  std::vector<Record> records{ate("raw", 1.0), ate("raw", 3.0), ate("worse", 9.0)};
  records.push_back(records[2]);
  records[3].kind.edit().axis = "x";
  for (const std::size_t i : {1u, 2u, 3u}) {
    records[i].status = Status::incomplete;
    records[i].why = "evaluated 1 of 9 poses";
  }
  records[1].cell.edit().repeat = 1;
  const std::vector<Table> tables = pivot(records, TableSpec{});
  EXPECT_EQ(tables[0].lines[0][1].value, 1.0);  // without the second repeat
  EXPECT_EQ(tables[0].lines[0][1].records, 1u);
  EXPECT_EQ(tables[0].lines[1][1].value, std::nullopt);
  EXPECT_EQ(tables[0].lines[1][1].status, "incomplete");
  EXPECT_EQ(note_texts(tables[0]),
            (std::vector<std::string>{"raw, worse: incomplete: evaluated 1 of 9 poses"}));
  EXPECT_NE(csv(records).find(",9,"), std::string::npos);  // the long table keeps the number
  EXPECT_TRUE(gains(records, "worse").empty());
}

TEST(Pivot, RefusesToAverageDifferentScores) {
  std::vector<Record> records{ate("raw", 1.0), ate("raw", 3.0)};
  records[1].kind.edit().relation = "rotation";
  records[1].kind.edit().unit = "deg";
  EXPECT_EQ(
      pivot(records, TableSpec{})[0].headings,
      (std::vector<std::string>{"method", "ate [m]", "ate [deg]"}));  // distinguished by the unit
  records[1].kind.edit().unit = "m";
  EXPECT_THROW(pivot(records, TableSpec{}), InputError);
}

TEST(Pivot, RefusesUnknownColumnsByName) {
  TableSpec spec;
  spec.rows = {"mehtod"};
  EXPECT_THROW(pivot({ate("raw", 1.0)}, spec), InputError);
  spec = {};
  spec.value = "rms";
  EXPECT_THROW(pivot({ate("raw", 1.0)}, spec), InputError);
}

}  // namespace
}  // namespace loopbench::compared_sweep::pivot_test
