/// Comparisons of two methods are blind to third ones, and consistent.
#include "harness/answers/compare/pair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "harness/answers/compare/compare.hpp"

namespace loopbench::pair_test {

using namespace harness;

namespace {

#ifdef NDEBUG
constexpr int kStores = 20'000;
#else
constexpr int kStores = 2'000;
#endif

GroupedValues of(std::vector<std::vector<double>> values) {
  GroupedValues out;
  for (const std::vector<double>& row : values) out.values.emplace_back(row.begin(), row.end());
  for (std::size_t i = 0; i < values[0].size(); ++i) out.group.push_back(i);
  return out;
}

Pair pair_of(const GroupedValues& all) { return compared(Levels(all, kTieShare), 0, 1); }

bool is_better(const GroupedValues& all) {
  const RandomizationTest test = pair_of(all).test();
  return test.typical() < 0.0 && test.p() <= 0.05;
}

/// Three methods, of which the first is mostly better; the last is a nuisance.
GroupedValues random_store(std::mt19937_64& bits) {
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  const std::size_t runs = 6 + bits() % 7;
  const double effect = -0.6 * uniform();
  const double failures = uniform() < 0.5 ? 0.0 : 0.25 * uniform();
  GroupedValues out;
  out.values.resize(3);
  const std::size_t in_group = 1 + bits() % 2;
  for (std::size_t run = 0; run < runs * in_group; ++run) {
    const double size = std::exp(4.0 * uniform());
    for (std::size_t m = 0; m < 3; ++m) {
      const double value = size * std::exp((m == 0 ? effect : 0.0) + uniform() - 0.5);
      const bool fails = uniform() < failures;
      out.values[m].push_back(fails ? kFailed : value);
    }
    if (uniform() < 0.1) out.values[2].back() = 1e12 * size;
    if (uniform() < 0.1) out.values[2].back() = std::nullopt;
    out.group.push_back(run / in_group);
  }
  return out;
}

TEST(Pair, IsBlindToThirdMethods) {
  std::mt19937_64 bits(18);
  for (int i = 0; i < kStores; ++i) {
    GroupedValues all = random_store(bits);
    const Pair with = pair_of(all);
    all.values.pop_back();
    const Pair without = pair_of(all);
    ASSERT_EQ(with.groups, without.groups);
    ASSERT_EQ(with.mean, without.mean);
    if (with.groups == 0) continue;
    ASSERT_EQ(with.test().typical(), without.test().typical());
    ASSERT_EQ(with.test().p(), without.test().p());
  }
}

TEST(Pair, KeepsItsClaimWhereSomeRunsAreFarBetter) {
  std::vector<double> raw(10, 1.0);
  std::vector<double> dual(10);
  for (std::size_t i = 0; i < 10; ++i) dual[i] = 0.95 - 1e-4 * static_cast<double>(i);
  EXPECT_TRUE(is_better(of({dual, raw})));
  dual[3] = dual[7] = 0.61;
  EXPECT_TRUE(is_better(of({dual, raw})));
  std::vector<double> many(100, 0.955);
  for (const std::size_t i : {5u, 50u, 95u}) many[i] = 1e-3;
  EXPECT_TRUE(is_better(of({many, std::vector<double>(100, 1.0)})));
}

TEST(Pair, HasNoNumbersOfFailures) {
  // Better by the same ratio on all runs that both solve.
  std::vector<double> raw(24, 1.0), often(24, 0.5);
  for (std::size_t run = 0; run < 10; ++run) often[run] = kFailed;
  const Pair pair = pair_of(of({often, raw}));
  EXPECT_EQ(pair.groups, 14u);
  EXPECT_EQ(pair.wins, 14u);
  EXPECT_DOUBLE_EQ(pair.test().typical(), std::log(0.5));
  EXPECT_EQ(pair.first_fails, 10u);
  EXPECT_TRUE(pair.first_fails_more());
  EXPECT_DOUBLE_EQ(pair.failure_p(), 2.0 / 1024.0);
  EXPECT_TRUE(pair.fails_beside(true));
  EXPECT_FALSE(pair.fails_beside(false));
}

TEST(Pair, HasAnIntervalThatExcludesZeroExactlyIfPIsSmall) {
  std::mt19937_64 bits(19);
  for (int i = 0; i < kStores / 10; ++i) {
    const Pair pair = pair_of(random_store(bits));
    if (pair.groups == 0) continue;
    const RandomizationTest test = pair.test();
    const auto found = test.interval(0.05);
    if (!found) continue;  // failed too often
    ASSERT_LE(found->low, found->estimate);
    ASSERT_LE(found->estimate, found->high);
    ASSERT_EQ(test.p() <= 0.05, found->low > 0.0 || found->high < 0.0);
  }
}

/// Ten runs of two systems on one sequence, or of several.
GroupedValues independent(std::mt19937_64& bits, double effect, std::size_t sequences) {
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  GroupedValues out;
  out.values.resize(2);
  out.is_paired = false;
  for (std::size_t sequence = 0; sequence < sequences; ++sequence) {
    const double size = std::exp(4.0 * uniform());
    for (std::size_t run = 0; run < 10; ++run) {
      out.sequence.push_back(sequence);
      out.group.push_back(out.group.size());
      out.values[0].push_back(size * std::exp(effect + uniform()));
      out.values[1].push_back(size * std::exp(uniform()));
    }
  }
  return out;
}

TEST(IndependentRuns, AreTheSameUnderAnyNumbers) {
  std::mt19937_64 bits(20);
  GroupedValues all = independent(bits, -0.3, 3);
  const RandomizationTest before = pair_of(all).test();
  for (int i = 0; i < 20; ++i) {
    for (std::vector<std::optional<double>>& row : all.values) {
      for (auto run = row.begin(); run != row.end(); run += 10) std::shuffle(run, run + 10, bits);
    }
    const RandomizationTest after = pair_of(all).test();
    EXPECT_NEAR(after.p(), before.p(), 1e-12);
    EXPECT_NEAR(after.interval(0.05)->low, before.interval(0.05)->low, 1e-9);
  }
}

TEST(IndependentRuns, HaveAnIntervalThatFollowsP) {
  std::mt19937_64 bits(21);
  int claims = 0;
  for (std::size_t i = 0; i < kStores / 100; ++i) {
    GroupedValues all = independent(bits, -0.4, 1 + i % 3);
    if (i % 4 == 0) all.values[i % 2][3] = kFailed;
    const RandomizationTest test = pair_of(all).test();
    const Interval typical = *test.interval(0.05);
    ASSERT_EQ(test.p() <= 0.05, typical.low > 0.0 || typical.high < 0.0);
    ASSERT_TRUE(typical.low <= typical.estimate && typical.estimate <= typical.high);
    claims += is_better(all) ? 1 : 0;
  }
  EXPECT_GT(claims, kStores / 500);
}

TEST(IndependentRuns, OfWhichEachSequenceHasOneAreComparedOverSequences) {
  GroupedValues all = of({{1, 2, 3, 4, 5, 6}, {1.1, 2.3, 3.5, 4.7, 6.1, 7.9}});
  const double paired = pair_of(all).test().p();
  all.is_paired = false;
  EXPECT_EQ(pair_of(all).test().p(), paired);
  EXPECT_EQ(paired, least_p_of(6, 0));
}

TEST(IndependentRuns, CountCopiesOfAFileOnce) {
  GroupedValues all = of({std::vector<double>(10, 1.0), {2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
  all.is_paired = false;
  all.sequence.assign(10, 0);
  EXPECT_NEAR(pair_of(all).test().p(), 2.0 / 11.0, 1e-12);
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

/// Two methods on sequences of eight runs with these effects, and some scatter.
GroupedValues by_sequence(const std::vector<double>& effects) {
  GroupedValues out;
  out.values.resize(2);
  for (std::size_t sequence = 0; sequence < effects.size(); ++sequence) {
    for (std::size_t run = 0; run < 8; ++run) {
      out.sequence.push_back(sequence);
      out.group.push_back(out.group.size());
      const double size = 1.0 + 0.1 * static_cast<double>((run * 5) % 8);
      out.values[0].push_back(size * (effects[sequence] + 0.0002 * static_cast<double>(run)));
      out.values[1].push_back(size);
    }
  }
  return out;
}

TEST(Sequences, CountOnceEachInTheTypicalRatio) {
  const RandomizationTest test = pair_of(by_sequence({0.9, 0.9, 0.9, 0.6})).test();
  EXPECT_NEAR(std::exp(test.typical()), std::pow(0.9 * 0.9 * 0.9 * 0.6, 0.25), 0.001);
  EXPECT_LE(test.p(), 0.05);
  // Three sequences are slightly worse, one is far better: that is the sign of the mean.
  const RandomizationTest against = pair_of(by_sequence({1.01, 1.012, 1.013, 0.81})).test();
  EXPECT_LT(against.typical(), 0.0);
  EXPECT_LT(against.interval(0.05)->high, 0.0);
}

}  // namespace
}  // namespace loopbench::pair_test
