/// The studentised bootstrap against every resample, by law, and where it declines.
#include "harness/statistics/mean_interval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace loopbench {
namespace {

using Numbers = std::vector<double>;

/// The 95 % quantile of |mean* - mean| / error* over all 5^5 resamples of five values.
double enumerated_quantile(const Numbers& x) {
  const auto moments = [](const Numbers& values) {
    double mean = 0.0;
    for (const double value : values) mean += value / 5.0;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::pair{mean, std::sqrt(squares / 4.0 / 5.0)};
  };
  const auto [mean, error] = moments(x);
  Numbers all;
  for (int code = 0; code < 3125; ++code) {
    Numbers resample;
    for (int i = 0, rest = code; i < 5; ++i, rest /= 5) {
      resample.push_back(x[static_cast<std::size_t>(rest % 5)]);
    }
    const auto [own_mean, own_error] = moments(resample);
    all.push_back(own_error > 1e-9 * error ? std::abs(own_mean - mean) / own_error : 1e9);
  }
  std::ranges::sort(all);
  return all[static_cast<std::size_t>(0.95 * 3126.0)];
}

TEST(MeanInterval, IsTheQuantileOfAllResamples) {
  const Numbers x{0.3, 1.1, 0.7, 2.9, -0.4};
  const auto found = mean_interval(x, {.resamples = 99999});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->interval.estimate, 0.92);
  double squares = 0.0;
  for (const double value : x) squares += (value - 0.92) * (value - 0.92);
  const double half = enumerated_quantile(x) * std::sqrt(squares / 20.0);
  EXPECT_NEAR(found->interval.high - 0.92, half, 0.02 * half);
  EXPECT_NEAR(0.92 - found->interval.low, half, 0.02 * half);
}

TEST(MeanInterval, ExcludesZeroExactlyWhereItsPIsAtMostTheRest) {
  Numbers x{0.9, 1.1, 0.7, 1.9, 0.4, 1.3, 0.8};
  int excluded = 0;
  for (int i = 0; i < 60; ++i) {
    const auto found = mean_interval(x);
    ASSERT_TRUE(found);
    const bool excludes = found->interval.low > 0.0 || found->interval.high < 0.0;
    EXPECT_EQ(excludes, found->p <= 0.05) << i;
    excluded += excludes ? 1 : 0;
    for (double& value : x) value -= 0.03;
  }
  EXPECT_GT(excluded, 0);
  EXPECT_LT(excluded, 60);
}

TEST(MeanInterval, DeclinesWhatSaysTooLittle) {
  EXPECT_FALSE(mean_interval(Numbers{1.0, 2.0, 3.0, 4.0}));
  EXPECT_FALSE(mean_interval(Numbers{1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0}));  // ties
  EXPECT_FALSE(mean_interval(Numbers{1.0, 1.0, 1.0, 1.0, 2.0}));            // hardly varies
  EXPECT_THROW(mean_interval(Numbers(5, 1.0), {.level = 1.0}), std::invalid_argument);
  EXPECT_THROW(mean_interval(Numbers(5, 1.0), {.resamples = 0}), std::invalid_argument);
}

TEST(MeanInterval, IsReproducibleAndAPointWhereNothingVaries) {
  const Numbers x{0.3, 1.1, 0.7, 2.9, -0.4};
  EXPECT_EQ(mean_interval(x)->interval.low, mean_interval(x)->interval.low);
  const auto constant = mean_interval(Numbers(6, 0.25));
  EXPECT_EQ(constant->interval.low, 0.25);
  EXPECT_EQ(constant->interval.high, 0.25);
}

}  // namespace
}  // namespace loopbench
