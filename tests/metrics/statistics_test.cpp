#include "metrics/numerics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

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
}

TEST(Statistics, MedianOfAnOddCountIsTheMiddleOne) {
  EXPECT_EQ(statistics({9.0, 1.0, 5.0}).median, 5.0);
  EXPECT_EQ(statistics({7.0}).median, 7.0);
  EXPECT_EQ(statistics({7.0}).std, 0.0);
}

TEST(Statistics, SumsOfAMillionKeepTheirDigits) {
  // 0.1 is not representable; plain summation gives an error of 1.3e-12 in the mean of a million.
  const Statistics s = statistics(std::vector<double>(1'000'000, 0.1));
  EXPECT_NEAR(s.mean, 0.1, 1e-15);
  EXPECT_NEAR(s.rmse, 0.1, 1e-15);
  EXPECT_LT(s.std, 1e-15);
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

}  // namespace
}  // namespace loopbench::statistics_test
