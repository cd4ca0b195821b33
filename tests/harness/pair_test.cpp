/// Comparisons of two methods are monotone, and blind to third ones.
#include "harness/answers/compare/pair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "harness/answers/compare/compare.hpp"
#include "harness/answers/compare/signed_rank.hpp"

namespace loopbench::pair_test {

using namespace harness;

namespace {

#ifdef NDEBUG
constexpr int kStores = 100'000;
#else
constexpr int kStores = 5'000;
#endif

GroupedValues of(std::vector<std::vector<double>> values) {
  GroupedValues out;
  for (const std::vector<double>& row : values) out.values.emplace_back(row.begin(), row.end());
  for (std::size_t i = 0; i < values[0].size(); ++i) out.group.push_back(i);
  return out;
}

Pair pair_of(const GroupedValues& all) { return compared(Levels(all, kTieShare), 0, 1); }

bool is_better(const GroupedValues& all, std::size_t tests = 1) {
  const Pair pair = pair_of(all);
  return pair.is_first_ahead() && pair.is_significant(level_of_one(0.05, tests));
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

TEST(Pair, IsMonotoneInEveryRun) {
  std::mt19937_64 bits(17);
  int claims = 0;
  for (int i = 0; i < kStores; ++i) {
    GroupedValues all = random_store(bits);
    if (!is_better(all)) continue;
    ++claims;
    const double before = pair_of(all).p;
    const std::size_t run = bits() % all.group.size();
    std::optional<double>& better = all.values[0][run];
    const double other = *all.values[1][run];
    const double factor = std::exp(-3.0 * static_cast<double>(bits() >> 11) * 0x1p-53);
    better = factor * (std::isnan(*better) ? std::isnan(other) ? 1.0 : other : *better);
    ASSERT_TRUE(is_better(all)) << "store " << i;
    // Ties of magnitudes, which failures are, can change p in its last digits only.
    ASSERT_LE(pair_of(all).p, before * (1.0 + 1e-9)) << "store " << i;
  }
  EXPECT_GT(claims, kStores / 10);
}

TEST(Pair, IsBlindToThirdMethods) {
  std::mt19937_64 bits(18);
  for (int i = 0; i < kStores; ++i) {
    GroupedValues all = random_store(bits);
    const Pair with = pair_of(all);
    const bool is_ahead = with.is_first_ahead() && with.is_significant(0.025);
    all.values.pop_back();
    const Pair without = pair_of(all);
    ASSERT_EQ(with.values, without.values);
    ASSERT_EQ(with.p, without.p);
    ASSERT_EQ(with.mean, without.mean);
    ASSERT_EQ(is_ahead, without.is_first_ahead() && without.is_significant(0.025));
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

TEST(Pair, CountsWinsAgainstAMethodThatFailsNearlyAlways) {
  std::vector<double> raw(24, 1.0);
  std::vector<double> rarely(24, kFailed);
  rarely[4] = 0.5;  // better on the only run that it ends
  EXPECT_TRUE(is_better(of({raw, rarely})));
  EXPECT_FALSE(is_better(of({rarely, raw})));
}

TEST(Pair, TypicalIntervalExcludesOneExactlyIfPIsSmall) {
  std::mt19937_64 bits(19);
  for (int i = 0; i < kStores / 10; ++i) {
    const Pair pair = pair_of(random_store(bits));
    const auto typical = pair.typical_interval(0.05);
    if (!typical) continue;  // both failed too often
    ASSERT_LE(typical->low, typical->estimate);
    ASSERT_LE(typical->estimate, typical->high);
    const bool has_zero = typical->low <= 0.0 && typical->high >= 0.0;
    const bool has_zero_inside = typical->low < 0.0 && typical->high > 0.0;
    ASSERT_TRUE(pair.p > 0.05 ? has_zero : !has_zero_inside);
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
  const Pair before = pair_of(all);
  for (int i = 0; i < 20; ++i) {
    for (std::vector<std::optional<double>>& row : all.values) {
      for (auto run = row.begin(); run != row.end(); run += 10) std::shuffle(run, run + 10, bits);
    }
    const Pair after = pair_of(all);
    EXPECT_EQ(after.p, before.p);
    EXPECT_EQ(after.typical_interval(0.05)->low, before.typical_interval(0.05)->low);
    EXPECT_NEAR(*after.mean, *before.mean, 1e-12);
  }
}

TEST(IndependentRuns, AreMonotoneAndTheirIntervalFollowsP) {
  std::mt19937_64 bits(21);
  int claims = 0;
  for (std::size_t i = 0; i < kStores / 10; ++i) {
    GroupedValues all = independent(bits, -0.4, 1 + i % 3);
    if (i % 4 == 0) all.values[i % 2][3] = kFailed;
    const Pair pair = pair_of(all);
    const Interval typical = *pair.typical_interval(0.05);
    const bool has_zero = typical.low <= 0.0 && typical.high >= 0.0;
    ASSERT_TRUE(pair.p > 0.05 ? has_zero : typical.low >= 0.0 || typical.high <= 0.0);
    ASSERT_TRUE(typical.low <= typical.estimate && typical.estimate <= typical.high);
    if (!is_better(all)) continue;
    ++claims;
    all.values[0][bits() % 10] = 1e-3;
    ASSERT_TRUE(is_better(all)) << "store " << i;
    ASSERT_LE(pair_of(all).p, pair.p);
  }
  EXPECT_GT(claims, kStores / 50);
}

TEST(IndependentRuns, OfWhichEachSequenceHasOneAreComparedOverSequences) {
  GroupedValues all = of({{1, 2, 3, 4, 5, 6}, {1.1, 2.3, 3.5, 4.7, 6.1, 7.9}});
  const double paired = pair_of(all).p;
  all.is_paired = false;
  EXPECT_EQ(pair_of(all).p, paired);
  EXPECT_EQ(pair_of(all).p, least_p(6));
}

TEST(IndependentRuns, CountCopiesOfAFileOnce) {
  GroupedValues all = of({std::vector<double>(10, 1.0), {2, 3, 4, 5, 6, 7, 8, 9, 10, 11}});
  all.is_paired = false;
  all.sequence.assign(10, 0);
  EXPECT_DOUBLE_EQ(pair_of(all).p, 2.0 / 11.0);
}

Comparison ranked(const GroupedValues& all) {
  Comparison out;
  out.methods.resize(all.values.size());
  rank_methods(Levels(all, kTieShare), out);
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
  // Six equal signs have p = 1 / 32: too large for Holm over the six pairs of four methods.
  const Comparison best =
      ranked({beside(1.0, 6, 0), beside(0.8, 6, 0), beside(1.3, 6, 0), beside(1.1, 6, 3)});
  EXPECT_TRUE(best.is_best);
  EXPECT_EQ(worse(best), (std::vector<bool>{true, false, true, true}));
}

TEST(Ranking, NamesWorseMethodsBesideASharedFirstPlace) {
  // Holm: 2^-15 is enough for the two pairs of the last method, nothing is for that of the others.
  std::vector<double> balanced = beside(1.0, 16, 0);
  for (std::size_t run = 0; run < 16; ++run) balanced[run] *= run % 4 % 3 == 0 ? 0.98 : 1.02;
  const Comparison shared = ranked({beside(1.0, 16, 0), balanced, beside(2.0, 16, 0)});
  EXPECT_FALSE(shared.is_best);
  EXPECT_EQ(worse(shared), (std::vector<bool>{false, false, true}));
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
  const Pair pair = pair_of(by_sequence({0.9, 0.9, 0.9, 0.6}));
  EXPECT_NEAR(std::exp(pair.typical()), std::pow(0.9 * 0.9 * 0.9 * 0.6, 0.25), 0.001);
  EXPECT_TRUE(pair.is_significant(0.05));
  // Three sequences are slightly worse, one is far better: the test and the mean differ in sign.
  const Pair against = pair_of(by_sequence({1.01, 1.012, 1.013, 0.81}));
  EXPECT_LT(against.typical(), 0.0);
  EXPECT_FALSE(against.is_first_ahead());
  EXPECT_FALSE(against.is_significant(0.05));
}

TEST(Sequences, ThatDisagreeLeaveNoClaimOverAll) {
  const Pair divided = pair_of(by_sequence({0.5, 0.5, 0.5, 1.02}));
  EXPECT_LT(divided.p, 0.05);
  EXPECT_TRUE(divided.is_divided());
  EXPECT_FALSE(divided.is_significant(0.05));
}

}  // namespace
}  // namespace loopbench::pair_test
