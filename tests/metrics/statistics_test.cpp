/// The median equals that of the sorted list bit by bit for any values.
#include "metrics/numerics/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "metrics/numerics/average.hpp"
#include "metrics/numerics/median.hpp"

namespace loopbench::statistics_test {

using namespace metrics;

namespace {

TEST(Statistics, OfFourNumbersByHand) {
  const Statistics s = statistics({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.sse, 30.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  // Ranks 2.7, 2.85 and 2.97 of the sorted numbers.
  EXPECT_DOUBLE_EQ(s.p90, 3.7);
  EXPECT_DOUBLE_EQ(s.p95, 3.85);
  EXPECT_DOUBLE_EQ(s.p99, 3.97);
}

TEST(Spread, OfARectangleIsHalfItsDiagonal) {
  const std::vector<Vector3> corners{{1, 1, 7}, {7, 1, 7}, {7, 9, 7}, {1, 9, 7}};
  EXPECT_DOUBLE_EQ(spread_of(corners.size(), [&](std::size_t i) { return corners[i]; }), 5.0);
}

TEST(Statistics, PercentilesDoNotDependOnTheOrder) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back((i * 358) % 1001);  // 0 to 1000, shuffled
  const Statistics s = statistics(values);
  EXPECT_EQ(s.p90, 900.0);
  EXPECT_EQ(s.p95, 950.0);
  EXPECT_EQ(s.p99, 990.0);
  EXPECT_EQ(statistics({7.0}).p99, 7.0);
}

TEST(Statistics, SumsOfAMillionKeepTheirDigits) {
  // 0.1 is not representable; plain summation gives an error of 1.3e-12 in the mean of a million.
  const Statistics s = statistics(std::vector<double>(1'000'000, 0.1));
  EXPECT_NEAR(s.mean, 0.1, 5e-15);
  EXPECT_NEAR(s.rmse, 0.1, 1e-15);
  EXPECT_NEAR(s.std, 0.0, 5e-15);
}

TEST(Statistics, DividesByOneLessWhenAsked) {
  EXPECT_DOUBLE_EQ(statistics({1.0, 3.0}).std, 1.0);
  EXPECT_DOUBLE_EQ(statistics({1.0, 3.0}, 1).std, std::sqrt(2.0));
  EXPECT_EQ(statistics({1.0}, 1).std, 0.0);
}

TEST(Statistics, RefusesNothingAndNonsense) {
  EXPECT_THROW(statistics({}), std::invalid_argument);
  EXPECT_THROW(statistics({1.0, std::nan("")}), std::runtime_error);
  EXPECT_THROW(statistics({std::numeric_limits<double>::infinity()}), std::runtime_error);
  EXPECT_THROW(statistics({1e200}), std::runtime_error);
}

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
}  // namespace loopbench::statistics_test
