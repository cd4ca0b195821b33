/// Verdicts worked by hand.
#include "harness/compare/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "datasets/core/error.hpp"
#include "harness/compare/along_intervals.hpp"
#include "harness/export/comparison.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench {
namespace {

using namespace compared_sweep;  // NOLINT: its records are what every test here is about

TEST(Compare, GivesTheNumbersOfAHandWorkedSweep) {
  const Comparison c = compared(sweep());
  ASSERT_EQ(c.methods.size(), 4u);
  EXPECT_EQ(c.observations, 8u);
  EXPECT_EQ(c.sequences, 2u);
  const MethodVerdict& dual = c.methods[0];
  EXPECT_EQ(dual.method, "dual");
  double product = 1.0;
  for (int i = 0; i < 8; ++i) product *= 0.90 - 0.01 * i;
  EXPECT_NEAR(dual.ratio->estimate, std::pow(product, 1.0 / 8.0), 1e-12);
  EXPECT_GT(dual.ratio->low, 0.83);
  EXPECT_LT(dual.ratio->high, 0.90);
  EXPECT_EQ(dual.wins, 8u);
  EXPECT_NEAR(dual.p, 2.0 * 2.0 / 256.0 + 2.0 / 256.0, 1e-15);  // least p, Holm over 3 methods
  EXPECT_EQ(dual.rank_biserial, 1.0);
  EXPECT_EQ(dual.average_rank, 1.0);
  // uniform and copy share ranks 2 and 3; ties are no wins.
  EXPECT_EQ(c.methods[1].method, "uniform");
  EXPECT_EQ(c.methods[1].average_rank, 2.5);
  EXPECT_EQ(c.methods[2].average_rank, 2.5);
  EXPECT_EQ(c.methods[2].ties, 8u);
  EXPECT_EQ(c.methods[2].p, 1.0);
  EXPECT_EQ(c.methods[2].ratio->low, 1.0);
  EXPECT_EQ(c.methods[3].average_rank, 4.0);
  EXPECT_EQ(c.methods[3].losses, 8u);
  EXPECT_DOUBLE_EQ(c.methods[3].ratio->estimate, 2.0);
  EXPECT_DOUBLE_EQ(c.methods[3].median, 50.05);
  // Demsar: CD = 2.569 sqrt(4 * 5 / (6 * 8)) = 1.658.
  EXPECT_NEAR(c.critical_difference, 1.658, 5e-4);
  EXPECT_EQ(c.methods[0].groups, "a");
  EXPECT_EQ(c.methods[3].groups, "b");
  EXPECT_EQ(c.methods[1].groups, "ab");
}

std::string interval_text(double low, double high) {
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), "[%.1f, %.1f]", low, high);
  return out.data();
}

TEST(Verdict, IsOneLineThatSaysHowMuchAndHowSure) {
  const std::string text = verdict(compared(sweep()));
  EXPECT_EQ(text.find("dual ranks best: 13.5 % below uniform ["), 0u) << text;
  const MethodVerdict dual = compared(sweep()).methods[0];
  EXPECT_NE(
      text.find(interval_text(100.0 * (1.0 - dual.ratio->high), 100.0 * (1.0 - dual.ratio->low))),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("], p = 0.023; different from all others"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(Verdict, NamesWhoCannotBeToldFromTheBest) {
  std::vector<Record> records = sweep();
  for (int i = 0; i < 8; ++i) {
    const Record dual = records[static_cast<std::size_t>(4 * i + 2)];
    records.push_back(score(
        dual.sequence, i % 4, "pose_graph", dual.statistics.rmse * (i % 2 == 0 ? 1.001 : 0.9995)));
    records.push_back(score(dual.sequence, i % 4, "twin", dual.statistics.rmse));
  }
  // Eight runs and 15 pairs reach 0.12 at best.
  const std::string text = verdict(compared(records, {.baseline = "uniform", .alpha = 0.2}));
  EXPECT_NE(text.find("; the same on every run: twin; not proven different from pose_graph"),
            std::string::npos)
      << text;
}

TEST(Verdict, DoesNotContradictTheTestAgainstTheBaseline) {
  std::vector<Record> records = sweep();
  for (const char* more : {"b", "c", "d", "e"}) {  // so many pairs that none is proven
    for (const Record& r : sweep()) {
      if (r.method == "raw")
        records.push_back(score(r.sequence, static_cast<int>(r.repeat), more, 3.0));
    }
  }
  const std::string text = verdict(compared(records, {.baseline = "uniform", .alpha = 0.1}));
  EXPECT_NE(text.find("p = 0.055; no other method is proven different from it"), std::string::npos)
      << text;
}

TEST(Verdict, DoesNotClaimWhatSoFewRunsCannotShow) {
  std::vector<Record> records = sweep();
  std::erase_if(records, [](const Record& r) { return r.sequence == "city"; });
  const Comparison c = compared(records);
  const std::string text = verdict(c);
  EXPECT_EQ(text.find("dual ranks best: 11.5 % below uniform, which 4 observations cannot prove "
                      "against 3 methods (least p 0.38)"),
            0u)
      << text;
  EXPECT_FALSE(c.methods[0].has_interval);
  const std::vector<std::string> notes = remarks(c);
  EXPECT_EQ(notes.back(), "no interval from fewer than 5 runs");
}

TEST(Verdict, SaysThatNothingBeatsTheBaseline) {
  const Comparison c = compared(sweep(), {.baseline = "dual"});
  EXPECT_EQ(verdict(c), "nothing ranks better than the baseline dual; different from all others");
}

TEST(Compare, RanksOnlyRunsThatAllMethodsHaveAndSaysSo) {
  std::vector<Record> records = sweep();
  records[2] = failed("room", 0, "dual");
  records[7].status = "incomplete";  // copy, room, repeat 1
  records.push_back(failed("room", 0, "broken"));
  records.push_back(score("lonely", 0, "uniform", 1.0));
  const Comparison c = compared(records);
  EXPECT_EQ(c.observations, 6u);
  EXPECT_EQ(c.possible, 9u);
  EXPECT_EQ(c.methods[0].wins, 6u);
  const std::vector<std::string> notes = remarks(c);
  EXPECT_EQ(notes[0].find("over 6 of 9 runs, those on which every method has a value"), 0u)
      << notes[0];
  const auto has = [&](const std::string& text) { return std::ranges::count(notes, text) == 1; };
  EXPECT_TRUE(has("dual lacks 2 of 9 runs: failed 1, not run 1"));
  EXPECT_TRUE(has("copy lacks 2 of 9 runs: incomplete 1, not run 1"));
  EXPECT_TRUE(has("broken is not ranked, it has no value: failed 1, not run 8"));
}

TEST(Compare, LeavesOutWhoWasShownTheReference) {
  std::vector<Record> records = sweep();
  for (Record& r : records) r.oracle = r.method == "dual";
  const Comparison c = compared(records);
  EXPECT_EQ(c.methods.size(), 3u);
  EXPECT_EQ(c.methods[0].method, "uniform");
  const std::vector<std::string> notes = remarks(c);
  EXPECT_EQ(std::ranges::count(notes, "not ranked, shown the reference: dual"), 1);
}

TEST(Compare, WithoutACommonRunComparesNothing) {
  const Comparison c = compared({score("a", 0, "uniform", 1.0), score("b", 0, "dual", 0.5)});
  EXPECT_TRUE(c.methods.empty());
  EXPECT_EQ(verdict(c), "no run has a value of every method: nothing is compared");
  const Comparison lost = compared({failed("a", 0, "uniform"), score("a", 0, "dual", 0.5)});
  EXPECT_EQ(verdict(lost), "the baseline uniform has no value on any run: nothing is compared");
  const Comparison alone = compared({score("a", 0, "uniform", 1.0)});
  EXPECT_EQ(verdict(alone), "one method alone has values: nothing is compared");
}

TEST(Compare, AveragesRepeatsWhereSequencesAreAskedFor) {
  const Comparison c = compared(sweep(), {.baseline = "uniform", .over = Over::sequences});
  EXPECT_EQ(c.observations, 2u);
  EXPECT_EQ(c.methods[0].wins, 2u);
  double product = 1.0;
  for (int i = 0; i < 8; ++i) product *= 0.90 - 0.01 * i;
  EXPECT_NEAR(c.methods[0].ratio->estimate, std::pow(product, 1.0 / 8.0), 1e-12);
}

TEST(Compare, TakesDifferencesWhereValuesAreNotPositive) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    r.metric = "gain";
    r.better = Better::higher;
    r.statistics.rmse = r.method == "dual" ? 10.0 : r.method == "raw" ? 0.0 : -5.0;
  }
  const Comparison c = compared(records);
  EXPECT_EQ(c.methods[0].method, "dual");  // the higher gain
  EXPECT_EQ(c.methods[0].wins, 8u);
  EXPECT_EQ(c.methods[0].ratio, std::nullopt);
  EXPECT_EQ(c.methods[3].ratio, std::nullopt);
  EXPECT_EQ(verdict(c).find("dual ranks best: against uniform, p = "), 0u) << verdict(c);
  EXPECT_EQ(remarks(c).back(),
            "some values are not positive: no ratio there, p from plain differences");
}

TEST(Compare, KeepsScoresApartAndPassesDescriptionsOver) {
  std::vector<Record> records = sweep();
  for (Record r : sweep()) {
    r.times = "keyframes";
    records.push_back(r);
    r.metric = "pairs";
    r.better = Better::neither;
    records.push_back(r);
  }
  EXPECT_EQ(compare(records, {.baseline = "uniform"}).size(), 2u);
}

TEST(Compare, TakesTheDirectionFromTheScoreNotFromItsLabel) {
  std::vector<Record> records = sweep();
  for (Record& r : records) {
    r.metric = "gain_along";
    r.label = "gain_along improved or worsened";
    r.relation = "worsened";
  }
  EXPECT_EQ(compared(records).methods[0].method, "dual");  // worsens least
  for (Record& r : records) r.relation = "improved";
  for (Record& r : records) r.better = Better::higher;
  EXPECT_NE(compared(records).methods[0].method, "dual");
  for (Record& r : records) r.better = Better::neither;
  EXPECT_EQ(refusal_of([&] { compared(records); }),
            "'gain_along improved or worsened' describes: no value of it is better than another");
}

TEST(Compare, RefusesByName) {
  EXPECT_EQ(refusal_of([] { compared(sweep(), {.baseline = "unifrom"}); }),
            "baseline: no method is named 'unifrom'; did you mean 'uniform'?");
  EXPECT_NE(refusal_of([] { compared(sweep(), {.baseline = "raw", .value = "rms"}); }), "");
  EXPECT_NE(refusal_of([] { compared({failed("a", 0, "uniform")}); }), "");
}

TEST(ComparisonText, HasALinePerMethodInEveryFormat) {
  const std::vector<Comparison> all = compare(sweep(), {.baseline = "uniform"});
  const std::string text = markdown(sheet(all[0]));
  EXPECT_EQ(text.find("### ate rmse, dense, loopbench\n\n| method"), 0u) << text;
  EXPECT_NE(text.find("\n| dual    |"), std::string::npos) << text;
  EXPECT_NE(text.find("8/0/0"), std::string::npos);
  EXPECT_NE(text.find("\n- dual ranks best: "), std::string::npos);
  const std::string table = csv(all);
  EXPECT_EQ(std::ranges::count(table, '\n'), 5);
  EXPECT_NE(table.find("loopbench,dense,ate,ate,translation,3d,m,rmse,uniform,8,raw,"),
            std::string::npos)
      << table;
  EXPECT_NE(json(all).find("\"verdict\": \"dual ranks best"), std::string::npos);
}

/// Errors of 0.1 or 0.2 m in long stretches, `scale` times; every second stretch swaps them.
StampedErrors stretches(double scale, std::size_t poses = 400) {
  StampedErrors out;
  for (std::size_t i = 0; i < poses; ++i) {
    out.stamps.push_back(static_cast<double>(i));
    out.errors.push_back(scale * (i / 40 % 2 == 0 ? 0.1 : 0.2));
  }
  return out;
}

TEST(AlongRuns, GiveASingleRunAnIntervalThatKnowsOfStretches) {
  Comparison c = compared({score("room", 0, "uniform", 1.0), score("room", 0, "dual", 0.8)});
  ASSERT_FALSE(c.methods[0].has_interval);
  // Half of the time the methods are equal, half of the time dual has three quarters of the error.
  StampedErrors dual = stretches(1.0);
  for (double& error : dual.errors) error = error > 0.15 ? 0.15 : error;
  dual.stamps.insert(dual.stamps.begin(), -1.0);  // a pose that uniform lacks
  dual.errors.insert(dual.errors.begin(), 1000.0);
  const auto errors_of = [&](const std::string& method, const std::string& run) {
    EXPECT_EQ(run, "room");
    return method == "dual" ? dual : stretches(1.0);
  };
  add_intervals_along_runs(c, errors_of);
  ASSERT_TRUE(c.methods[0].has_interval);
  EXPECT_GE(c.longest_block, 20u);
  EXPECT_EQ(c.methods[0].ratio->estimate, 0.8);
  // The poses' own ratio is sqrt(0.0325 / 0.05) = 0.806; a resample without a good stretch has 1.
  EXPECT_LT(c.methods[0].ratio->low, 0.79);
  EXPECT_GT(c.methods[0].ratio->high, 0.82);
  EXPECT_LT(c.methods[0].ratio->high, 1.0);
  EXPECT_NE(verdict(c).find("dual ranks best: 20.0 % below uniform ["), std::string::npos);
}

TEST(AlongRuns, LeaveAloneWhatTheyCannotJudge) {
  const auto errors_of = [](const std::string&, const std::string&) { return stretches(1.0, 20); };
  Comparison c = compared({score("room", 0, "uniform", 1.0), score("room", 0, "dual", 0.8)});
  add_intervals_along_runs(c, errors_of);
  EXPECT_FALSE(c.methods[0].has_interval);  // too few poses
  Comparison many = compared(sweep());
  const Interval before = *many.methods[0].ratio;
  add_intervals_along_runs(many, errors_of);
  EXPECT_EQ(many.methods[0].ratio->low, before.low);  // enough runs
}

}  // namespace
}  // namespace loopbench
