/// Verdicts computed by hand.
#include "harness/answers/compare/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/answers/tables/comparison.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compared_sweep::compare_test {
namespace {

bool has_note(const Comparison& c, const std::string& text) {
  return std::ranges::count(remarks(c), text) == 1;
}

double geometric_mean_of_dual() {
  double product = 1.0;
  for (int i = 0; i < 8; ++i) product *= 0.90 - 0.01 * i;
  return std::pow(product, 1.0 / 8.0);
}

TEST(Compare, GivesTheNumbersOfAHandWorkedSweep) {
  const Comparison c = compared(sweep());
  ASSERT_EQ(c.methods.size(), 4u);
  EXPECT_EQ(c.groups, 8u);
  EXPECT_EQ(c.sequences, 2u);
  EXPECT_EQ(c.tests, 2u);  // copy and uniform do not differ: three methods
  const MethodVerdict& dual = c.methods[0];
  EXPECT_EQ(dual.method, "dual");
  EXPECT_NEAR(*dual.ratio->geometric_mean, geometric_mean_of_dual(), 1e-12);
  // The means of two logarithms are symmetric but for curvature; two are between 0.86 and 0.87.
  EXPECT_NEAR(dual.ratio->typical.estimate, std::sqrt(0.865 * 0.8646), 1e-3);
  EXPECT_GT(dual.ratio->typical.low, 0.83);
  EXPECT_LT(dual.ratio->typical.high, 0.90);
  EXPECT_EQ(dual.wins, 8u);
  // The smallest p of eight runs, corrected for two tests.
  EXPECT_NEAR(*dual.p, 1.0 - std::pow(1.0 - 2.0 / 256.0, 2), 1e-15);
  EXPECT_TRUE(c.is_best);
  EXPECT_FALSE(dual.is_worse);
  EXPECT_EQ(c.methods[1].method, "uniform");
  EXPECT_EQ(c.methods[2].ties, 8u);
  EXPECT_EQ(*c.methods[2].p, 1.0);
  EXPECT_EQ(c.methods[2].ratio->typical.estimate, 1.0);
  EXPECT_TRUE(c.methods[2].is_worse);
  EXPECT_EQ(c.methods[3].losses, 8u);
  EXPECT_DOUBLE_EQ(c.methods[3].ratio->typical.estimate, 2.0);
  EXPECT_DOUBLE_EQ(c.methods[3].median, 50.05);
}

TEST(Compare, TellsRunsWithEqualNamesApart) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    if (r.cell->sequence == "city") r.cell.edit().sequence = "room (repeat 1)";
  }
  const Comparison c = compared(records), plain = compared(sweep());
  EXPECT_EQ(c.groups, 8u);
  ASSERT_EQ(c.methods.size(), plain.methods.size());
  EXPECT_EQ(c.methods[0].p, plain.methods[0].p);
  EXPECT_EQ(c.methods[0].ratio->typical.estimate, plain.methods[0].ratio->typical.estimate);
}

TEST(Verdict, StatesHowMuchAndHowSureInOneLine) {
  EXPECT_EQ(sentence(compared(sweep())), "dual is best, 14 % below uniform (95 %: 11 to 16)");
}

TEST(Verdict, NamesAFirstPlaceThatIsShared) {
  std::vector<Record> records = sweep();
  for (int i = 0; i < 8; ++i) {
    const Record dual = records[static_cast<std::size_t>(4 * i + 2)];
    records.push_back(score(dual.cell->sequence,
                            i % 4,
                            "pose_graph",
                            dual.statistics.rmse * (i % 2 == 0 ? 1.001 : 0.9995)));
    records.push_back(score(dual.cell->sequence, i % 4, "twin", dual.statistics.rmse));
  }
  const Comparison c = compared(records, {.baseline = "uniform", .alpha = 0.2});
  EXPECT_EQ(sentence(c),
            "dual, twin and pose_graph share first place, 14 % below uniform (80 %: 11 to 16)");
  EXPECT_TRUE(has(markdown(table_view(c)), "\n| = pose_graph ")) << markdown(table_view(c));
}

TEST(Verdict, DoesNotClaimWhatSoFewRunsCannotShow) {
  std::vector<Record> records = sweep();
  std::erase_if(records, [](const Record& r) { return r.cell->sequence == "city"; });
  const Comparison c = compared(records);
  EXPECT_EQ(
      sentence(c),
      "4 runs of 1 sequence cannot decide among 3 methods: 7 would; dual is 12 % below uniform "
      "on 4 of 4");
  EXPECT_TRUE(has(terminal(verdict_table(verdict_of(c, {}))), "\nraw "));
  EXPECT_FALSE(c.methods[0].ratio->has_interval);
  EXPECT_FALSE(c.methods[0].p);
}

TEST(Verdict, StatesThatNothingBeatsTheBaseline) {
  const std::string text = sentence(compared(sweep(), {.baseline = "dual"}));
  EXPECT_TRUE(text.starts_with("the baseline dual is best: uniform is 16 % above dual (95 %: "))
      << text;
}

TEST(Verdict, IsAboutTheFailuresOfABaselineThatRanksBehindAWorseMethod) {
  std::vector<Record> records;
  for (int i = 0; i < 8; ++i) {
    records.push_back(i < 2 ? score("room", i, "raw", 1.0) : failed("room", i, "raw"));
    records.push_back(score("room", i, "dual", 1.25));
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_EQ(sentence(c),
            "8 runs of 1 sequence, of which two methods solved at most 2, cannot decide between 2 "
            "methods: 6 "
            "would; dual is 25 % above raw on 2 of 8 runs; raw fails on 6");
  EXPECT_TRUE(
      has(limitations(c)[0], "no value on 6 of 8 runs (failed 6); changes are over the runs"));
}

TEST(Relevance, MakesSmallDifferencesTies) {
  std::vector<Record> records;
  for (int i = 0; i < 12; ++i) {
    const double size = 1.0 + i;
    records.push_back(score("room", i, "uniform", size));
    records.push_back(score("room", i, "dual", size * (1.0 - 1e-7)));
  }
  const Comparison equal = compared(records);
  EXPECT_EQ(equal.methods[0].ties, 12u);
  EXPECT_EQ(sentence(equal), "all methods are equal");
  // With less tolerance it counts as a difference, but the two are as good; no 0.0 % is printed.
  CompareOptions options{.baseline = "uniform", .tie = 1e-9};
  const Comparison near = compared(records, options);
  EXPECT_FALSE(near.is_best);
  EXPECT_EQ(sentence(near),
            "no method is best: dual is 1e-05 % below uniform (95 %: 1e-05 to 1e-05)");
  options.relevant = 0.0;
  EXPECT_TRUE(
      sentence(compared(records, options)).starts_with("dual is best, 1e-05 % below uniform"));
}

TEST(Direction, ComesFromTheRecordNotFromItsLabel) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    r.kind.edit().metric = "gain_along";
    r.kind.edit().label = "gain_along worsened";
    r.kind.edit().better = Better::lower;
  }
  EXPECT_EQ(compared(records).methods[0].method, "dual");
  for (Record& r : records) r.kind.edit().better = Better::higher;
  EXPECT_EQ(compared(records).methods[0].method, "raw");
  EXPECT_DOUBLE_EQ(compared(records).methods[0].ratio->typical.estimate, 2.0);
  records.back().kind.edit().better = Better::lower;  // a metric that changes its mind
  EXPECT_EQ(
      refusal_of([&] { compared(records); }),
      "'gain_along worsened' is descriptive, or its best value differs between cells: no value "
      "is better than another");
}

TEST(Direction, OfATargetIsTheDistanceToIt) {
  std::vector<Record> records;
  for (int i = 0; i < 8; ++i) {
    records.push_back(score("room", i, "uniform", 1.2 + 0.01 * i));
    records.push_back(score("room", i, "dual", 0.9 - 0.001 * i));
    records.push_back(score("room", i, "raw", 0.5));
  }
  for (Record& r : records) {
    r.kind.edit().better = Better::target;
    r.kind.edit().target = 1.0;
  }
  const Comparison c = compared(records);
  EXPECT_EQ(c.methods[0].method, "dual");
  EXPECT_EQ(c.methods[2].method, "raw");
  EXPECT_TRUE(c.is_best);
  EXPECT_TRUE(has(sentence(c), " % closer to 1 than uniform (95 %: ")) << sentence(c);
  EXPECT_TRUE(has(remarks(c)[0], "typical |value - 1| / uniform")) << remarks(c)[0];
}

TEST(Coverage, OfALeaderThatIsLessThanThatOfOthersLeavesNoBest) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    r.pairs = r.possible = 100;
    if (r.cell->method == "dual") r.span = 0.53;
    if (r.cell->method == "raw") r.pairs = 91;
    if (r.cell->method == "copy") r.pairs = 89;
  }
  const Comparison c = compared(records);
  EXPECT_FALSE(c.is_best);
  EXPECT_EQ(sentence(c),
            "no method is best: dual covers 53 %, copy covers 89 % of the reference, others up to "
            "100 %");
  EXPECT_TRUE(has_note(c,
                       "dual covers 53 %, copy covers 89 % of the reference, others up to 100 %; "
                       "errors are over the parts that are covered"))
      << json({c});
  EXPECT_TRUE(has(json({c}), "\"coverage\": 0.53"));
  EXPECT_FALSE(has(sentence(compared(sweep())), "covers"));
}

TEST(Compare, LeavesOutMethodsThatWereShownTheReference) {
  std::vector<Record> records = sweep();
  for (Record& r : records) r.cell.edit().oracle = r.cell->method == "dual";
  const Comparison c = compared(records);
  EXPECT_EQ(c.methods.size(), 3u);
  EXPECT_EQ(c.methods[0].method, "uniform");
  EXPECT_TRUE(has_note(c, "not ranked because they use the reference (oracle): dual"));
}

TEST(Compare, FlagsOracleClosuresAndOracleData) {
  std::vector<Record> records = sweep();
  for (Record& r : records)
    r.cell.edit().oracle_closures = r.cell.edit().oracle = r.cell->sequence == "room";
  const Comparison c = compared(records);  // every method has the same access to the reference
  EXPECT_EQ(c.methods.size(), 4u);
  EXPECT_TRUE(has_note(c, "closures measured in the reference, or selected by it (oracle): room"));
  EXPECT_TRUE(has(json({c}), "\"oracle_closures\": [\n      \"room\"")) << json({c});
}

TEST(Compare, WithoutACommonRunComparesNothing) {
  const Comparison c = compared({score("a", 0, "uniform", 1.0), score("b", 0, "dual", 0.5)});
  EXPECT_TRUE(c.methods.empty());
  EXPECT_EQ(sentence(c), "no run has values of two methods: nothing is compared");
  const Comparison lost = compared({failed("a", 0, "uniform"), score("a", 0, "dual", 0.5)});
  EXPECT_EQ(sentence(lost), "the baseline uniform has no value on any run: nothing is compared");
  const Comparison alone = compared({score("a", 0, "uniform", 1.0)});
  EXPECT_EQ(sentence(alone), "one method alone has values: nothing is compared");
}

TEST(Compare, TakesDifferencesWhereValuesAreNegative) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    r.kind.edit().metric = "gain";
    r.kind.edit().better = Better::higher;
    r.statistics.rmse = r.cell->method == "raw" ? 0.0 : -5.0;
    if (r.cell->method == "dual") r.statistics.rmse = 10.0;
  }
  const Comparison c = compared(records);
  EXPECT_EQ(c.methods[0].method, "dual");  // the higher gain
  EXPECT_EQ(c.methods[0].wins, 8u);
  EXPECT_FALSE(c.methods[0].ratio);
  EXPECT_EQ(sentence(c), "dual is best, better than uniform on 8 of 8 runs");
  EXPECT_TRUE(has_note(c, "no change is given for methods with negative values"));
  EXPECT_TRUE(has(remarks(c)[1], "p: randomization test of differences against uniform"));
}

TEST(Ratio, IsDeclinedWhereTheBaselineIsPerfect) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    if (r.cell->method == "uniform" && r.cell->sequence == "room") r.statistics.rmse = 3e-16;
  }
  const Comparison c = compared(records);
  const auto dual = std::ranges::find(c.methods, "dual", &MethodVerdict::method);
  EXPECT_TRUE(!dual->ratio || !dual->ratio->geometric_mean);
  EXPECT_EQ(dual->losses, 4u);  // an error of zero wins without a ratio
}

TEST(Compare, KeepsScoresApartAndPassesDescriptionsOver) {
  std::vector<Record> records = sweep();
  for (Record r : sweep()) {
    r.kind.edit().times = "keyframes";
    records.push_back(r);
    r.kind.edit().metric = "pairs";
    r.kind.edit().better = Better::neither;
    records.push_back(r);
  }
  EXPECT_EQ(compare(records, {.baseline = "uniform"}).size(), 2u);
}

TEST(Compare, RejectsRecordsWithoutScores) {
  EXPECT_NE(refusal_of([] { compared({failed("a", 0, "uniform")}); }), "");
}

TEST(ComparisonText, HasALinePerMethodInEveryFormat) {
  const std::vector<Comparison> all = compare(sweep(), {.baseline = "uniform"});
  const std::string text = markdown(table_view(all[0]));
  EXPECT_EQ(text.find("### ate rmse, dense, loopbench\n\n| method"), 0u) << text;
  EXPECT_TRUE(has(text, "\n| **= dual**")) << text;
  EXPECT_TRUE(has(text, "|          8/0 |"));
  const std::string table = csv(all);
  EXPECT_EQ(std::ranges::count(table, '\n'), 5);
  EXPECT_TRUE(has(table, "loopbench,dense,ate,ate,translation,3d,m,rmse,uniform,groups,8,8,raw,"))
      << table;
  EXPECT_TRUE(
      has(json(all),
          "\"verdict\": \"ate, dense: dual is best, 14 % below uniform (95 %: 11 to 16).\""));
}

}  // namespace
}  // namespace loopbench::compared_sweep::compare_test
