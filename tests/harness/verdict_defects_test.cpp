/// Wrong verdicts of earlier procedures, each with the smallest sweep that showed it. The numbers
/// are those of the list of defects.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/answers/compare/derived.hpp"
#include "harness/sweep/model/evaluated_run.hpp"
#include "tests/studies/synthetic_records.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::verdict_defects_test {
namespace {

const CompareOptions kAgainstRaw{.baseline = "raw"};

const MethodVerdict& find(const Comparison& c, const std::string& method) {
  return *std::ranges::find(c.methods, method, &MethodVerdict::method);
}

/// An error that differs between runs.
double size_of(int run) { return 0.1 + 0.013 * run; }

/// Runs of `raw`, and of `dual` with these ratios to it.
std::vector<Record> pairs(const std::vector<double>& ratios) {
  std::vector<Record> out;
  for (int run = 0; run < std::ssize(ratios); ++run) {
    out.push_back(score("room", run, "raw", size_of(run)));
    out.push_back(score("room", run, "dual", ratios[static_cast<std::size_t>(run)] * size_of(run)));
  }
  return out;
}

/// About `ratio`, all different.
std::vector<double> about(double ratio, int runs) {
  std::vector<double> out;
  for (int run = 0; run < runs; ++run) out.push_back(ratio * (1.0 + 0.001 * run));
  return out;
}

TEST(Defect1, ADivergingThirdMethodChangesNoNumberOfOthers) {
  std::vector<Record> records = pairs(about(0.75, 12));
  const MethodVerdict alone = find(compared(records, kAgainstRaw), "dual");
  const std::vector<Record> gain = gains(records, "raw");
  for (int run = 0; run < 12; ++run) {
    records.push_back(score("room", run, "lost", run < 10 ? 1e9 : 0.7 * size_of(run)));
  }
  const MethodVerdict beside = find(compared(records, kAgainstRaw), "dual");
  EXPECT_EQ(beside.ratio->typical.estimate, alone.ratio->typical.estimate);
  EXPECT_EQ(*beside.ratio->geometric_mean, *alone.ratio->geometric_mean);
  EXPECT_EQ(beside.wins, 12u);
  EXPECT_TRUE(beside.beats_baseline);
  const std::vector<Record> all = gains(records, "raw");
  for (const Record& r : gain) {
    const auto same = std::ranges::find_if(all, [&](const Record& other) {
      return other.cell->method == r.cell->method && other.cell->repeat == r.cell->repeat;
    });
    EXPECT_EQ(same->statistics.rmse, r.statistics.rmse);
  }
  EXPECT_EQ(std::ranges::count_if(all,
                                  [](const Record& r) {
                                    return r.cell->method == "lost" && r.statistics.rmse < -1e9;
                                  }),
            10);
}

TEST(Defect2, AMethodThatFailsNearlyAlwaysVetoesNothing) {
  std::vector<Record> records = pairs(about(0.73, 24));
  for (int run = 0; run < 24; ++run) {
    records.push_back(run == 4 ? score("room", run, "mostly fails", 0.3 * size_of(run))
                               : failed("room", run, "mostly fails"));
  }
  const Comparison c = compared(records, kAgainstRaw);
  EXPECT_TRUE(sentence(c).starts_with("dual is best, ")) << sentence(c);
  EXPECT_TRUE(has(limitations(c)[0], "no value on 23 of 24 runs (failed 23)")) << limitations(c)[0];
}

TEST(Defect3, OneRunOfTwentyDecidesNeitherTheNumberNorP) {
  std::vector<double> ratios = about(1.05, 20);
  ratios[7] = 0.01;  // one win, 19 losses
  const Comparison c = compared(pairs(ratios), kAgainstRaw);
  const MethodVerdict& dual = find(c, "dual");
  EXPECT_LT(*dual.p, 0.01);
  EXPECT_GT(dual.ratio->typical.low, 1.0);
  EXPECT_LT(*dual.ratio->geometric_mean, 1.0);
  EXPECT_TRUE(sentence(c).starts_with("the baseline raw is best: dual is 5.9 % above raw"))
      << sentence(c);
}

TEST(Defect5, MethodsThatDifferByLessThanARelevantDifferenceShareThePlace) {
  std::vector<Record> records;  // smooth is 0.3 % below dm, but 3 % above it on `sparse`
  for (int seed = 0; seed < 16; ++seed) {
    for (const std::string sequence : {"room", "city", "hall", "sparse"}) {
      const double noise = 1.0 + 0.0001 * ((seed * 7) % 16 - 7.5);
      const bool is_sparse = sequence == "sparse";
      records.push_back(score(sequence, seed, "raw", 2.0 * size_of(seed)));
      records.push_back(score(sequence, seed, "dm", (is_sparse ? 0.8 : 1.0) * size_of(seed)));
      records.push_back(
          score(sequence, seed, "smooth", (is_sparse ? 0.824 : 0.997) * noise * size_of(seed)));
      records.push_back(score(sequence, seed, "dual", 1.001 / noise * size_of(seed)));
    }
  }
  const Comparison c = compared(records, kAgainstRaw);
  EXPECT_TRUE(sentence(c).starts_with("dm and smooth are best, ")) << sentence(c);
  EXPECT_TRUE(find(c, "dual").is_worse);
}

TEST(Defect7, AFailureIsNoNumber) {
  std::vector<Record> records = pairs(about(0.6, 20));
  const MethodVerdict all = find(compared(records, kAgainstRaw), "dual");
  for (const std::size_t run : {3u, 11u}) records[2 * run + 1] = failed("room", int(run), "dual");
  const Comparison c = compared(records, kAgainstRaw);
  const MethodVerdict& dual = find(c, "dual");
  EXPECT_NEAR(dual.ratio->typical.estimate, all.ratio->typical.estimate, 1e-3);
  EXPECT_TRUE(dual.ratio->has_interval);
  EXPECT_EQ(dual.wins, 18u);
  EXPECT_EQ(dual.losses, 0u);
  EXPECT_TRUE(dual.beats_baseline);
  EXPECT_FALSE(c.is_best);
  EXPECT_EQ(sentence(c),
            "no method is best: dual is 39 % below raw (95 %: 39 to 40) on 18 of 20 runs; dual "
            "fails on 2");
}

TEST(Defect12, TheLeadersIntervalHoldsAmongTwentyOneEqualMethods) {
  std::mt19937_64 bits(5);
  const synthetic::Truth equal{.effects = std::vector<double>(21, 0.0), .groups = 20};
  const synthetic::Shape normal = synthetic::shapes()[0];
  int excluded = 0;
  for (int draw = 0; draw < 150; ++draw) {
    const std::vector<Record> records = synthetic::records(equal, normal, bits);
    const Interval leader = compared(records, {.baseline = "m0"}).methods.front().ratio->typical;
    excluded += leader.low > 1.0 || leader.high < 1.0 ? 1 : 0;
  }
  EXPECT_LE(excluded, 18);  // 5 % and four standard errors; it was 20 %
}

TEST(Defect13, ADifferenceThatDoesNotMatterIsNoAdvantage) {
  std::vector<Record> records = pairs(about(0.56, 12));
  for (int run = 0; run < 12; ++run) {
    records.push_back(
        score("room", run, "near", 1.005 * 0.56 * (1.0 + 0.001 * run) * size_of(run)));
    records.push_back(score("room", run, "next", 1.03 * 0.56 * (1.0 + 0.001 * run) * size_of(run)));
  }
  const std::string text = sentence(compared(records, kAgainstRaw));
  EXPECT_TRUE(text.starts_with("dual and near are best, 44 % below raw (95 %: ")) << text;
  std::vector<double> ratios;
  for (int run = 0; run < 40; ++run) ratios.push_back(1.0 - 1e-5 * (1.0 + 0.01 * run));
  const std::string same = sentence(compared(pairs(ratios), kAgainstRaw));
  EXPECT_TRUE(same.starts_with("no method is best: dual is 0.0012 % below raw (95 %: ")) << same;
}

TEST(Defect14, MethodsThatAreExcludedOnSomeRunsDoNotEndTheComparison) {
  std::vector<Record> records = pairs(about(0.7, 8));
  for (int run = 0; run < 8; ++run) {
    const std::string learnt = run < 4 ? "learnt on b" : "learnt on a";
    records.push_back(score("room", run, learnt, 0.9 * size_of(run)));
  }
  const Comparison c = compared(records, kAgainstRaw);
  EXPECT_EQ(c.runs, 8u);
  EXPECT_EQ(c.methods.size(), 4u);
  EXPECT_EQ(find(c, "dual").wins, 8u);
}

TEST(Defect14, DeclinesAreNoFailures) {
  std::vector<Record> records = pairs(about(0.7, 8));
  for (const std::size_t run : {1u, 2u}) {
    records[2 * run + 1] = failed("room", int(run), "dual");
    records[2 * run + 1].status = Status::declined;
  }
  const Comparison c = compared(records, kAgainstRaw);
  EXPECT_EQ(find(c, "dual").fails, 0u);
  EXPECT_EQ(find(c, "dual").losses, 0u);
  EXPECT_TRUE(has(limitations(c)[0], "no value on 2 of 8 runs (declined 2): dual"));
}

TEST(Defect14, DifferentValuesOnEqualDataAreReported) {
  std::vector<Record> records = pairs(about(0.7, 3));
  for (Record& r : records) r.cell.edit().content = "c0ffee";
  for (std::size_t i = 0; i < records.size(); i += 2) records[i].statistics.rmse = 0.1;
  const std::vector<std::string> notes = limitations(compared(records, kAgainstRaw));
  EXPECT_EQ(std::ranges::count(notes, "not deterministic: values differ on equal data: dual"), 1);
}

/// Ten runs of each of two systems on one sequence, of which the second fails on six.
TEST(Defect15, IndependentRunsAreNoGroupsAndABaselineDoesNotDifferFromItself) {
  std::vector<Record> records;
  for (int run = 0; run < 10; ++run) {
    records.push_back(score("office", run, "good", 0.01 + 0.001 * run));
    records.push_back(run < 6 ? failed("office", run, "bad")
                              : score("office", run, "bad", 0.03 + 0.001 * run));
  }
  records.push_back(failed("office", 10, "bad"));
  for (Record& r : records) {
    set_evaluated_group(r.cell.edit(), std::to_string(r.cell->repeat), "a");
  }
  const Comparison against_bad = compared(records, {.baseline = "bad"});
  EXPECT_TRUE(sentence(against_bad).starts_with("good is best, ")) << sentence(against_bad);
  EXPECT_TRUE(sentence(against_bad).ends_with("; bad fails on 6 of 10 runs"))
      << sentence(against_bad);
  const Comparison c = compared(records, {.baseline = "good"});
  const MethodVerdict& good = find(c, "good");
  EXPECT_EQ(good.wins + good.losses, 0u);
  EXPECT_EQ(good.ratio->typical.low, 1.0);
  EXPECT_EQ(good.ratio->typical.high, 1.0);
  const std::vector<std::string> notes = limitations(c);
  EXPECT_EQ(std::ranges::count(
                notes, "10 of 11 possible runs are compared: those on which a method has a value"),
            1);
}

TEST(Defect16, IntervalsStateTheirLevel) {
  const Comparison c = compared(pairs(about(0.7, 12)), {.baseline = "raw", .alpha = 0.1});
  EXPECT_EQ(verdict_of(c, {}).level, 90.0);
}

}  // namespace
}  // namespace loopbench::compared_sweep::verdict_defects_test
