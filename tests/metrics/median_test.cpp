/// The median equals that of the sorted list bit by bit for any values.
#include "metrics/numerics/median.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "metrics/numerics/statistics.hpp"

namespace loopbench::median_test {

using namespace metrics;

namespace {

double by_sorting(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

TEST(Median, OfFewByHand) {
  EXPECT_EQ(median(std::vector{3.0}), 3.0);
  EXPECT_EQ(median(std::vector{3.0, 1.0}), 2.0);
  EXPECT_EQ(median(std::vector{3.0, 1.0, -8.0}), 1.0);
  EXPECT_EQ(median(std::vector{4.0, 1.0, 2.0, 3.0}), 2.5);
}

TEST(Median, IsThatOfTheSortedList) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto fill = [&](std::size_t n, auto value) {
    std::vector<double> out(n);
    for (double& x : out) x = value(normal(random));
    return out;
  };
  for (const std::size_t n : {4095u, 4096u, 4097u, 10'000u, 10'001u}) {
    for (const auto& values : {
             fill(n, [](double x) { return x; }),
             fill(n, [](double x) { return std::exp(30.0 * x); }),
             fill(n, [](double x) { return 1e6 + 1e-3 * x; }),
             fill(n, [](double x) { return x < 0.0 ? 0.0 : -0.0; }),
             fill(n, [](double x) { return x < 0.0 ? 1.0 : 1e300; }),
             fill(n, [](double x) { return x * std::numeric_limits<double>::denorm_min(); }),
         }) {
      EXPECT_EQ(median(values), by_sorting(values)) << n;
    }
  }
}

TEST(Median, IsRightWhereTheSampleIsUnlikeTheRest) {
  // Every tenth value is in the sample, and far above the others.
  std::vector<double> values(40'960);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(i % 10 == 0 ? 1'000'000 + i : i % 777);
  }
  EXPECT_EQ(median(values), by_sorting(values));
}

TEST(Median, BetweenTwoFarApart) {
  std::vector<double> values(10'000, 1.0);
  std::fill(values.begin(), values.begin() + 5'000, 3e9);
  EXPECT_EQ(median(values), 1.5e9 + 0.5);
}

TEST(Statistics, OfManyByHand) {
  std::vector<double> values(300'001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  const Statistics s = statistics(values);
  EXPECT_EQ(s.count, 300'001u);
  EXPECT_EQ(s.mean, 150'000.0);
  EXPECT_EQ(s.median, 150'000.0);
  EXPECT_EQ(s.min, 0.0);
  EXPECT_EQ(s.max, 300'000.0);
  EXPECT_NEAR(s.sse, 300'000.0 * 300'001.0 * 600'001.0 / 6.0, 1e-14 * s.sse);
  EXPECT_NEAR(s.std, std::sqrt((300'001.0 * 300'001.0 - 1.0) / 12.0), 1e-9 * s.std);
}

/// The summation that statistics() documents, on one thread.
double pairwise_squares(const double* first, std::size_t n) {
  if (n > 128) return pairwise_squares(first, n / 2) + pairwise_squares(first + n / 2, n - n / 2);
  double total = 0.0;
  for (std::size_t i = 0; i < n; ++i) total += first[i] * first[i];
  return total;
}

TEST(Statistics, ThreadsDoNotMatter) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> values(1'234'567);
  for (double& value : values) value = std::exp(normal(random));
  EXPECT_EQ(statistics(values).sse, pairwise_squares(values.data(), values.size()));
  EXPECT_EQ(statistics(values).median, by_sorting(values));
}

}  // namespace
}  // namespace loopbench::median_test
