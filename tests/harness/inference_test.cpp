/// Statistical tests compared with published examples and with R and scipy.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/answers/compare/rank_sum.hpp"
#include "harness/answers/compare/signed_rank.hpp"
#include "metrics/numerics/average.hpp"

namespace loopbench::inference_test {

using namespace metrics;
using namespace harness;

namespace {

using Numbers = std::vector<double>;

Numbers differences(const Numbers& x, const Numbers& y) {
  Numbers out;
  for (std::size_t i = 0; i < x.size(); ++i) out.push_back(x[i] - y[i]);
  return out;
}

/// Hamilton depression scale of 9 patients (Hollander and Wolfe 1973, p. 29; R's ?wilcox.test).
Numbers depression() {
  return differences({1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30},
                     {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29});
}

TEST(Average, IsWhatItsNameSays) {
  EXPECT_DOUBLE_EQ(mean(Numbers{1.0, 2.0, 6.0}), 3.0);
  EXPECT_DOUBLE_EQ(sample_deviation(Numbers{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}),
                   std::sqrt(32.0 / 7.0));
  EXPECT_THROW(mean(Numbers{}), std::invalid_argument);
  EXPECT_THROW(sample_deviation(Numbers{1.0}), std::invalid_argument);
}

TEST(Normal, AgreesWithItsTables) { EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-15); }

TEST(Ranks, AreSharedByEquals) {
  EXPECT_EQ(midranks(Numbers{3.0, 1.0, 3.0, 2.0}), (Numbers{3.5, 1.0, 3.5, 2.0}));
  const Numbers close{1.0, 1.0 + 1e-12, 2.0};
  EXPECT_EQ(midranks(close), (Numbers{1.0, 2.0, 3.0}));
}

/// By enumerating all sign patterns: the definition. Patterns of `count` ranks with the sum `t`
/// come before those of more ranks with the same sum.
double enumerated(const Numbers& ranks, double t, std::size_t count) {
  double tail = 0.0;
  const std::size_t patterns = std::size_t{1} << ranks.size();
  for (std::size_t pattern = 0; pattern < patterns; ++pattern) {
    double sum = 0.0;
    std::size_t terms = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      const bool is_in = (pattern >> i & 1) != 0;
      sum += is_in ? ranks[i] : 0.0;
      terms += is_in ? 1 : 0;
    }
    tail += sum < t || (sum == t && terms <= count) ? 1.0 : 0.0;
  }
  return std::min(1.0, 2.0 * tail / static_cast<double>(patterns));
}

Numbers ranks_to(std::size_t n) {
  Numbers out;
  for (std::size_t i = 1; i <= n; ++i) out.push_back(static_cast<double>(i));
  return out;
}

TEST(SignedRank, GivesTheSumsOfRAndOrdersEqualOnes) {
  // R 4: wilcox.test(x, y, paired = TRUE): V = 40, p-value = 0.03906.
  const SignedRank depressed = signed_rank(depression());
  EXPECT_EQ(depressed.positive, 40.0);
  EXPECT_DOUBLE_EQ(depressed.p, 20.0 / 512.0);
  // Differences of heights of maize (Darwin 1876), as in the documentation of scipy.stats.wilcoxon.
  const SignedRank maize =
      signed_rank(Numbers{6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75});
  EXPECT_EQ(maize.negative, 24.0);
  EXPECT_LE(maize.p, 0.041259765625);  // of all patterns with this sum
  EXPECT_DOUBLE_EQ(maize.p, enumerated(ranks_to(15), 24.0, 2));
  // Of eight values, both patterns with a sum of 4 have 7 / 128 in R; one of them is below 5 %.
  EXPECT_DOUBLE_EQ(signed_rank(Numbers{1, 2, 3, -4, 5, 6, 7, 8}).p, 6.0 / 128.0);
  EXPECT_DOUBLE_EQ(signed_rank(Numbers{-1, 2, -3, 4, 5, 6, 7, 8}).p, 7.0 / 128.0);
  EXPECT_EQ(signed_rank(Numbers{-1, -2, 3}).p, signed_rank(Numbers{1, 2, -3}).p);
}

TEST(SignedRank, GivesTheNormalValuesOfR) {
  // test_accuracy_wilcoxon in the same file, for R's correct = TRUE.
  const Numbers twelve = differences({120, 114, 181, 188, 180, 146, 121, 191, 132, 113, 127, 112},
                                     {133, 143, 119, 189, 112, 199, 198, 113, 115, 121, 142, 187});
  EXPECT_NEAR(signed_rank(twelve, 0).p, 0.7240817, 5e-8);
  Numbers coarse;  // 56 integers from -4 to 4, 15 of them zero
  const std::size_t times[] = {1, 4, 16, 15, 8, 4, 5, 1, 2};
  for (int i = 0; i < 9; ++i) coarse.insert(coarse.end(), times[i], i - 4);
  EXPECT_EQ(signed_rank(coarse).positive, 423.0);
}

TEST(SignedRank, IsExactWithTiesAndZeros) {
  // Magnitudes 0 0 1 1 2 3 3 3: ranks 1.5 1.5 | 3.5 3.5 5 7 7 7, of which Pratt keeps the last six.
  const Numbers d{0.0, 1.0, -1.0, 0.0, 2.0, 3.0, 3.0, 3.0};
  const SignedRank test = signed_rank(d);
  EXPECT_EQ(test.count, 6u);
  EXPECT_EQ(test.positive, 29.5);
  EXPECT_EQ(test.negative, 3.5);
  EXPECT_DOUBLE_EQ(test.p, enumerated({3.5, 3.5, 5, 7, 7, 7}, 3.5, 1));
}

TEST(SignedRank, OfNothingButTiesIsNoDifference) {
  EXPECT_EQ(signed_rank(Numbers{0.0, 0.0, 0.0}).p, 1.0);
  EXPECT_EQ(signed_rank(Numbers{}).p, 1.0);
}

TEST(SignedRank, ReachesItsLeastP) {
  EXPECT_DOUBLE_EQ(signed_rank(Numbers{1, 2, 3, 4, 5}).p, least_p(5));
  EXPECT_DOUBLE_EQ(least_p(6), 0.03125);
  EXPECT_EQ(least_p(0), 1.0);
}

TEST(SignedRank, IsContinuousFromExactToNormal) {
  Numbers d;
  for (int i = 1; i <= 50; ++i) d.push_back(i % 3 == 0 ? -i : i);
  EXPECT_NE(signed_rank(d).p, signed_rank(d, 49).p);
  EXPECT_NEAR(signed_rank(d).p, signed_rank(d, 49).p, 1e-3);
}

TEST(SignedRank, HasTheCriticalSumsOfTheTables) {
  // Hollander and Wolfe, table A.4: two-sided 5 % and 1 %.
  EXPECT_EQ(critical_rank_sum(5, 0.05), std::nullopt);
  EXPECT_EQ(critical_rank_sum(6, 0.05), 0u);
  EXPECT_EQ(critical_rank_sum(10, 0.05), 8u);
  EXPECT_EQ(critical_rank_sum(15, 0.01), 15u);
  EXPECT_EQ(critical_rank_sum(50, 0.05), 434u);
  EXPECT_EQ(critical_rank_sum(51, 0.05), 453u);  // normal approximation
}

TEST(RankSum, HasTheValuesOfTheTables) {
  // Mann and Whitney (1947), table I: P(U <= u) for samples of 4 and 3, and of 8 and 8.
  const auto tail = [](std::size_t m, std::size_t n, std::size_t u) {
    return rank_sum_tail(std::vector<Stratum>{{m, n}}, u);
  };
  EXPECT_NEAR(tail(3, 4, 0), 1.0 / 35.0, 1e-15);
  EXPECT_NEAR(tail(4, 3, 3), 7.0 / 35.0, 1e-15);
  EXPECT_NEAR(tail(8, 8, 13), 0.0249, 5e-4);
  EXPECT_EQ(critical_pairs(std::vector<Stratum>{{8, 8}}, 0.05), 13u);
  EXPECT_EQ(critical_pairs(std::vector<Stratum>{{3, 3}}, 0.05), std::nullopt);
  // One run of either method in each of six sequences: six fair coins.
  const std::vector<Stratum> coins(6, {1, 1});
  EXPECT_DOUBLE_EQ(rank_sum_tail(coins, 0), 1.0 / 64.0);
  EXPECT_DOUBLE_EQ(rank_sum_tail(coins, 2), 22.0 / 64.0);
  // Strata are independent: P(U1 + U2 <= 1) for samples of 2 and 2, of which 0 and 1 have 1 / 6.
  EXPECT_NEAR(rank_sum_tail(std::vector<Stratum>{{2, 2}, {2, 2}}, 1), 3.0 / 36.0, 1e-15);
  // Exact and normal at their border.
  EXPECT_NEAR(tail(70, 71, 2000), tail(71, 71, 2028), 3e-3);
}

TEST(TypicalDifference, IsTheMedianOfMeansOfTwo) {
  // Means of {1, 2, 6}: 1, 1.5, 2, 3.5, 4, 6.
  const Numbers values{1.0, 2.0, 6.0};
  EXPECT_EQ(pseudo_median(values), 2.75);
  const Numbers sorted{1.0, 1.5, 2.0, 3.5, 4.0, 6.0};
  for (std::size_t k = 1; k <= 6; ++k) EXPECT_EQ(walsh_average(values, k), sorted[k - 1]);
  // One failure: six of ten means are finite, and those with the failure are last.
  const Numbers failure{1.0, 2.0, 6.0, kNoRatio};
  EXPECT_EQ(walsh_average(failure, 6), 6.0);
  EXPECT_EQ(walsh_average(failure, 7), kNoRatio);
  EXPECT_EQ(pseudo_median(Numbers{-kNoRatio, 3.0, kNoRatio}), 3.0);
}

TEST(TypicalDifference, HasTheIntervalOfR) {
  // R: wilcox.test(x, y, paired = TRUE, conf.int = TRUE) on the depression scores of Hollander and
  // Wolfe, 3.1: estimate 0.46, interval 0.01 to 0.786; its p is 0.039.
  Numbers values = depression();
  std::ranges::sort(values);
  const auto found = shift_interval(values, 0.05);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->estimate, 0.46, 1e-9);
  EXPECT_NEAR(found->low, 0.01, 1e-9);
  EXPECT_NEAR(found->high, 0.786, 1e-9);
  EXPECT_FALSE(shift_interval(std::span(values).first(5), 0.05));
  // It ends where p crosses the level.
  Numbers some{-0.7, 1.0, 2.1, 3.3, 4.7};
  for (double next = 6.2; some.size() < 12; next *= 1.27) {
    some.push_back(next);
    const auto interval = shift_interval(some, 0.05);
    const auto p_at = [&](double shift) {
      Numbers shifted = some;
      for (double& value : shifted) value -= shift;
      return signed_rank(shifted).p;
    };
    EXPECT_LE(p_at(interval->low - 1e-6), 0.05);
    EXPECT_GT(p_at(interval->low + 1e-6), 0.05);
    EXPECT_GT(p_at(interval->high - 1e-6), 0.05);
    EXPECT_LE(p_at(interval->high + 1e-6), 0.05);
  }
}

}  // namespace
}  // namespace loopbench::inference_test
