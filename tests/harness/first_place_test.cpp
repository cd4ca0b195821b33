/// Which methods share the first place, and which are worse.
#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::first_place_test {

using namespace harness;

namespace {

GroupedValues of(std::vector<std::vector<double>> values) {
  GroupedValues out;
  for (const std::vector<double>& row : values) out.values.emplace_back(row.begin(), row.end());
  for (std::size_t i = 0; i < values[0].size(); ++i) out.group.push_back(i);
  return out;
}

Comparison ranked(const GroupedValues& all) {
  Comparison out;
  out.methods.resize(all.values.size());
  rank_methods(Levels(all, kTieShare), 0, out);
  return out;
}

Comparison ranked(std::vector<std::vector<double>> values) { return ranked(of(std::move(values))); }

std::vector<bool> worse(const Comparison& c) {
  std::vector<bool> out;
  for (const MethodVerdict& m : c.methods) out.push_back(m.is_worse);
  return out;
}

TEST(Ranking, HasNoBestBesideAMethodOfFewRuns) {
  GroupedValues all =
      of({{1, 2, 3, 4, 5, 6}, {0.9, 1.8, 2.6, 3.5, 4.4, 5.1}, {0.1, 1, 1, 1, 1, 1}});
  for (std::size_t run = 1; run < 6; ++run) all.values[2][run] = std::nullopt;
  const Comparison ranking = ranked(all);
  EXPECT_FALSE(ranking.is_best);
  EXPECT_FALSE(ranking.methods[2].is_worse);
}

TEST(Ranking, CountsEqualMethodsOnce) {
  std::vector<double> raw{1, 2, 3, 4, 5, 6};
  std::vector<double> dual;
  for (const double value : raw) dual.push_back(0.8 * value - 0.01 * value * value);
  const Comparison two = ranked({raw, dual});
  EXPECT_TRUE(two.is_best);
  EXPECT_EQ(two.groups_needed, 6u);
  const Comparison three = ranked({raw, dual, dual});
  EXPECT_TRUE(three.is_best);
  EXPECT_EQ(three.tests, 1u);
  EXPECT_EQ(worse(three), (std::vector<bool>{true, false, false}));
}

/// `ratio` times 1, 2, ... of which `losses` runs are as much worse.
std::vector<double> beside(double ratio, std::size_t runs, std::size_t losses) {
  std::vector<double> out;
  for (std::size_t run = 0; run < runs; ++run) {
    const double size = 1.0 + static_cast<double>(run);
    const double own = ratio + 0.001 * size;
    out.push_back(size * (run < losses ? 1.0 / own : own));
  }
  return out;
}

TEST(Ranking, CallsAMethodBestThatBeatsEachRivalWithoutCorrection) {
  // Of 8 runs, one is worse than the last rival: 4 / 256 is too large for Holm over six pairs.
  const Comparison best =
      ranked({beside(1.0, 8, 0), beside(0.8, 8, 0), beside(1.3, 8, 0), beside(0.9, 8, 0)});
  EXPECT_TRUE(best.is_best);
  EXPECT_EQ(worse(best), (std::vector<bool>{true, false, true, true}));
}

TEST(Ranking, ShowsNothingOfSoFewRuns) {
  // Six equal signs have p = 1 / 32, and 1 - (31 / 32)^3 = 0.0909 among four methods.
  const Comparison few =
      ranked({beside(1.0, 6, 0), beside(0.8, 6, 0), beside(1.3, 6, 0), beside(1.1, 6, 3)});
  EXPECT_FALSE(few.can_show);
  EXPECT_FALSE(few.is_best);
  EXPECT_EQ(few.groups_needed, 7u);
}

TEST(Ranking, NamesWorseMethodsBesideASharedFirstPlace) {
  std::vector<double> balanced = beside(1.0, 16, 0);
  for (std::size_t run = 0; run < 16; ++run) balanced[run] *= run % 4 % 3 == 0 ? 0.98 : 1.02;
  const Comparison shared = ranked({beside(1.0, 16, 0), balanced, beside(2.0, 16, 0)});
  EXPECT_FALSE(shared.is_best);
  EXPECT_EQ(worse(shared), (std::vector<bool>{false, false, true}));
}

TEST(Ranking, HasNoFirstPlaceForABaselineThatIsShownToBeWorse) {
  // Three methods are 67 % below the baseline and equal to each other.
  std::vector<std::vector<double>> all{beside(1.0, 8, 0)};
  for (const double scatter : {0.05, -0.05, 0.03}) {
    all.push_back(beside(0.33, 8, 0));
    for (std::size_t run = 0; run < 8; ++run)
      all.back()[run] *= std::exp(run % 2 == 0 ? scatter : -scatter);
  }
  all.push_back(beside(0.97, 8, 4));
  const Comparison c = ranked(all);
  EXPECT_TRUE(c.methods[0].is_worse);
  EXPECT_FALSE(c.methods[1].is_worse || c.methods[2].is_worse || c.methods[3].is_worse);
}

TEST(Ranking, HasNoMethodFirstAloneThatFailsOnRunsThatAnotherSolves) {
  GroupedValues all = of({beside(1.0, 10, 0), beside(0.5, 10, 0), beside(1.2, 10, 0)});
  all.values[1][3] = all.values[1][7] = kFailed;
  const Comparison c = ranked(all);
  EXPECT_FALSE(c.is_best);
  EXPECT_EQ(worse(c), (std::vector<bool>{false, false, true}));
  // The other one fails on all other runs.
  GroupedValues often = of({beside(1.0, 30, 0), beside(0.5, 30, 0)});
  for (std::size_t run = 0; run < 20; ++run) often.values[0][run] = kFailed;
  often.values[1][25] = kFailed;
  EXPECT_TRUE(ranked(often).is_best);
}

}  // namespace
}  // namespace loopbench::first_place_test
