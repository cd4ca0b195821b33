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
