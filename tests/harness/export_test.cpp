#include <gtest/gtest.h>

#include "datasets/core/error.hpp"
#include "harness/compare/derived.hpp"
#include "harness/tables/notes.hpp"
#include "harness/tables/pivot.hpp"
#include "harness/tables/record_csv.hpp"

namespace loopbench::export_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

Record ate(const std::string& method, double rmse, const std::string& times = "keyframes") {
  Record r;
  r.sequence = "room";
  r.method = method;
  r.times = times;
  r.metric = "ate";
  r.relation = "translation";
  r.axis = "3d";
  r.unit = "m";
  r.statistics.rmse = rmse;
  r.milliseconds = 2.5;
  return r;
}

Record failed(const std::string& method, const std::string& why) {
  Record r;
  r.sequence = "room";
  r.method = method;
  r.status = Status::failed;
  r.why = why;
  return r;
}

TEST(Gain, IsMeasuredFromTheBaselineOfTheSameTimes) {
  const std::vector<Record> g = gains({ate("raw", 0.2),
                                       ate("uniform", 0.05),
                                       ate("raw", 0.4, "dense"),
                                       ate("uniform", 0.5, "dense")},
                                      "raw");
  ASSERT_EQ(g.size(), 4u);
  EXPECT_DOUBLE_EQ(g[0].statistics.rmse, 0.0);
  EXPECT_DOUBLE_EQ(g[1].statistics.rmse, 75.0);
  EXPECT_DOUBLE_EQ(g[3].statistics.rmse, -25.0);  // worse is negative
  EXPECT_EQ(g[3].unit, "%");
  EXPECT_TRUE(gains({ate("raw", 0.2)}, "").empty());
}

TEST(Gain, IsDeclinedWhereTheBaselineIsPerfect) {
  const std::vector<Record> g = gains({ate("raw", 1e-16), ate("uniform", 0.15)}, "raw");
  EXPECT_EQ(g[1].status, Status::declined);
  EXPECT_EQ(g[1].why, "the error of the baseline raw is zero");
}

TEST(RunTimes, AreOnePerCellAndTimes) {
  std::vector<Record> records{ate("raw", 0.2), ate("raw", 0.1), failed("bad", "why")};
  records[1].axis = "x";
  const std::vector<Record> t = run_times(records);
  ASSERT_EQ(t.size(), 1u);
  EXPECT_EQ(t[0].statistics.rmse, 2.5);
  EXPECT_EQ(t[0].unit, "ms");
}

TEST(Markdown, IsPaddedAndTellsReasons) {
  const std::vector<Table> tables =
      pivot({ate("raw", 0.25), ate("a|b", 12.5), failed("bad", "no such luck")}, TableSpec{});
  EXPECT_EQ(
      markdown(tables),
      "### room, keyframes\n"
      "\n"
      "| method | ate [m] |\n"
      "| ------ | ------: |\n"
      "| raw    |    0.25 |\n"
      "| a\\|b   |   12.50 |\n"
      "| bad    |  failed |\n"
      "\n"
      "- bad: failed: no such luck\n"
      "- no best value is marked: 1 independent run per entry cannot show a difference at 0.05\n");
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

TEST(Pivot, AveragesWhatFallsTogether) {
  std::vector<Record> records{ate("raw", 1.0), ate("raw", 3.0)};
  records[1].repeat = 1;
  const std::vector<Table> tables = pivot(records, TableSpec{});
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_DOUBLE_EQ(*tables[0].lines[0][1].mean->value, 2.0);
  EXPECT_EQ(tables[0].lines[0][1].mean->records, 2u);
}

TEST(Pivot, LeavesIncompleteNumbersOutAndSaysSoOnce) {
  std::vector<Record> records{ate("raw", 1.0), ate("raw", 3.0), ate("worse", 9.0)};
  records.push_back(records[2]);
  records[3].axis = "x";
  for (const std::size_t i : {1u, 2u, 3u}) {
    records[i].status = Status::incomplete;
    records[i].why = "evaluated 1 of 9 poses";
  }
  records[1].repeat = 1;
  const std::vector<Table> tables = pivot(records, TableSpec{});
  EXPECT_EQ(tables[0].lines[0][1].mean->value, 1.0);  // without the second repeat
  EXPECT_EQ(tables[0].lines[0][1].mean->records, 1u);
  EXPECT_EQ(tables[0].lines[1][1].mean->value, std::nullopt);
  EXPECT_EQ(tables[0].lines[1][1].mean->status, "incomplete");
  EXPECT_EQ(tables[0].notes,
            (std::vector<std::string>{"raw, worse: incomplete: evaluated 1 of 9 poses"}));
  EXPECT_NE(csv(records).find(",9,"), std::string::npos);  // the long table keeps the number
  EXPECT_TRUE(gains(records, "worse").empty());
}

TEST(Pivot, RefusesToAverageDifferentScores) {
  std::vector<Record> records{ate("raw", 1.0), ate("raw", 3.0)};
  records[1].relation = "rotation";
  records[1].unit = "deg";
  EXPECT_EQ(pivot(records, TableSpec{})[0].headings,
            (std::vector<std::string>{"method", "ate [m]", "ate [deg]"}));  // distinguished by the unit
  records[1].unit = "m";
  EXPECT_THROW(pivot(records, TableSpec{}), InputError);
}

TEST(Markdown, TellsMeansAndHidesNegativeZero) {
  std::vector<Record> records{ate("raw", -1e-9), ate("raw", -1e-9)};
  const std::string text = markdown(pivot(records, TableSpec{}));
  EXPECT_NE(text.find("- each number is the mean of up to 2 cells\n"), std::string::npos) << text;
  EXPECT_NE(text.find("|  0.0000 |"), std::string::npos) << text;
}

TEST(Pivot, RefusesUnknownColumnsByName) {
  TableSpec spec;
  spec.rows = {"mehtod"};
  EXPECT_THROW(pivot({ate("raw", 1.0)}, spec), InputError);
  spec = {};
  spec.value = "rms";
  EXPECT_THROW(pivot({ate("raw", 1.0)}, spec), InputError);
}

TEST(Csv, QuotesAndKeepsFullPrecision) {
  std::vector<Record> records{ate("a, \"b\"", 0.1)};
  const std::string text = csv(records);
  EXPECT_NE(
      text.find("\nroom,0,\"a, "
                "\"\"b\"\"\",,false,false,,,keyframes,ate,ate,translation,3d,m,lower,,0,0.1,"),
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
}

}  // namespace
}  // namespace loopbench::export_test
