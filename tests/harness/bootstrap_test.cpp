/// Intervals by resampling against R and closed forms.
#include "harness/statistics/bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "harness/statistics/block_length.hpp"

namespace loopbench {
namespace {

using Numbers = std::vector<double>;

Resampled mean_of(const Numbers& values) {
  return [&values](std::span<const std::size_t> indices) {
    double sum = 0.0;
    for (const std::size_t i : indices) sum += values[i];
    return sum / static_cast<double>(indices.size());
  };
}

TEST(Bootstrap, AgreesWithThePackageBoot) {
  // scipy/stats/tests/test_resampling.py, test_bootstrap_against_R: boot.ci with a million
  // resamples; percentile (28.86, 84.21), BCa (32.31, 91.43). Half a percent there with a million
  // resamples; a tenth of them leaves twice that of noise in the bias correction.
  const Numbers x{10, 12, 12.5, 12.5, 13.9, 15, 21, 22, 23, 34, 50, 81, 89, 121, 134, 213};
  const BootstrapOptions options{.resamples = 100000};
  const Interval percentile = percentile_interval(x.size(), mean_of(x), options);
  EXPECT_NEAR(percentile.low, 28.86, 0.005 * 28.86);
  EXPECT_NEAR(percentile.high, 84.21, 0.005 * 84.21);
  const Interval bca = bca_interval(x.size(), mean_of(x), options);
  EXPECT_NEAR(bca.low, 32.31, 0.01 * 32.31);
  EXPECT_NEAR(bca.high, 91.43, 0.01 * 91.43);
  EXPECT_DOUBLE_EQ(bca.estimate, 863.9 / 16.0);
}

TEST(Bootstrap, IsTheSameTwiceAndDegenerateWhenNothingVaries) {
  const Numbers x{1.0, 4.0, 2.0, 8.0, 5.0, 7.0};
  const Interval a = bca_interval(6, mean_of(x));
  const Interval b = bca_interval(6, mean_of(x));
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  const BootstrapOptions few{.resamples = 50};
  const BootstrapOptions other{.resamples = 50, .seed = 2};
  EXPECT_NE(bca_interval(6, mean_of(x), few).low, bca_interval(6, mean_of(x), other).low);
  const Numbers same(5, 0.25);
  EXPECT_EQ(bca_interval(5, mean_of(same)).low, 0.25);
  EXPECT_EQ(bca_interval(5, mean_of(same)).high, 0.25);
  EXPECT_THROW(bca_interval(1, mean_of(same)), std::invalid_argument);
  EXPECT_THROW(bca_interval(0, mean_of(same)), std::invalid_argument);
  EXPECT_THROW(percentile_interval(5, mean_of(same), {.level = 1.0}), std::invalid_argument);
}

/// x[i] = rho x[i - 1] + uniform noise of unit variance.
Numbers autoregressive(double rho, std::size_t n) {
  std::mt19937_64 bits(7);
  Numbers out{0.0};
  while (out.size() < n) {
    const double uniform = static_cast<double>(bits() >> 11) * 0x1p-53;
    out.push_back(rho * out.back() + std::sqrt(12.0) * (uniform - 0.5));
  }
  return out;
}

TEST(BlockLength, IsNearItsClosedFormForAutoregression) {
  // Politis and White 2004, section 3: G / g(0) = 2 rho / (1 - rho^2) for AR(1), so that the best
  // circular block is (1.5 (2 rho / (1 - rho^2))^2 n)^(1/3): 49.1 for rho 0.8, n 4000.
  EXPECT_NEAR(static_cast<double>(block_length(autoregressive(0.8, 4000))), 49.1, 0.35 * 49.1);
  EXPECT_LE(block_length(autoregressive(0.0, 4000)), 6u);
  // A half wave: the lags' sums cancel, but a third of the wave still goes together.
  Numbers wave;
  for (int i = 0; i < 90; ++i) wave.push_back(std::cos(i * 3.141592653589793 / 90.0));
  EXPECT_GE(block_length(wave), 20u);
  EXPECT_EQ(block_length(Numbers(10, 3.0)), 1u);
  EXPECT_EQ(block_length(Numbers{1.0}), 1u);
}

TEST(BlockBootstrap, KnowsThatNeighboursRepeatEachOther) {
  // The mean of AR(1) has variance 1 / ((1 - rho)^2 n): five times the standard error that
  // independent draws would show for rho 0.8, 3 times in terms of the sample's own spread.
  const Numbers x = autoregressive(0.8, 4000);
  const double error = 1.0 / (0.2 * std::sqrt(4000.0));
  const auto width = [](const Interval& i) { return (i.high - i.low) / (2.0 * 1.96); };
  const BootstrapOptions options{.resamples = 1000};
  EXPECT_NEAR(
      width(block_interval(x.size(), block_length(x), mean_of(x), options)) / error, 1.0, 0.15);
  EXPECT_NEAR(width(percentile_interval(x.size(), mean_of(x), options)) / error, 1.0 / 3.0, 0.05);
  EXPECT_THROW(block_interval(5, 0, mean_of(x)), std::invalid_argument);
  const Interval whole = block_interval(5, 9, mean_of(x));
  EXPECT_EQ(whole.low, whole.high);
}

}  // namespace
}  // namespace loopbench
