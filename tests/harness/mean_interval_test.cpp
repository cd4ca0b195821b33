/// Worked intervals, agreement with p, coverage, and where no interval is given.
#include "harness/statistics/mean_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "harness/statistics/student.hpp"

namespace loopbench::mean_interval_test {

using namespace harness;

namespace {

using Numbers = std::vector<double>;

TEST(Student, AgreesWithTables) {  // R: qt(0.975, c(1, 2, 4, 7, 29))
  EXPECT_NEAR(student_quantile(0.05, 1), 12.706204736174698, 1e-10);
  EXPECT_NEAR(student_quantile(0.05, 2), 4.302652729749464, 1e-12);
  EXPECT_NEAR(student_quantile(0.05, 4), 2.776445105197794, 1e-12);
  EXPECT_NEAR(student_quantile(0.05, 7), 2.364624251592784, 1e-12);
  EXPECT_NEAR(student_quantile(0.05, 29), 2.045229642132703, 1e-12);
  EXPECT_NEAR(student_p(-1.0, 1), 0.5, 1e-14);                        // atan(1) = pi / 4
  EXPECT_NEAR(student_p(1.0, 2), 1.0 - 1.0 / std::sqrt(3.0), 1e-14);  // t / sqrt(2 + t^2)
  EXPECT_EQ(student_p(0.0, 5), 1.0);
}

TEST(MeanInterval, IsStudentsWhereValuesAreSymmetric) {
  const auto found = mean_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  ASSERT_TRUE(found);
  const double half = 2.364624251592784 * std::sqrt(6.0 / 8.0);  // variance 6
  EXPECT_DOUBLE_EQ(found->interval.estimate, 4.5);
  EXPECT_NEAR(found->interval.low, 4.5 - half, 1e-12);
  EXPECT_NEAR(found->interval.high, 4.5 + half, 1e-12);
  EXPECT_NEAR(found->p, student_p(4.5 / std::sqrt(0.75), 7), 1e-14);
}

TEST(MeanInterval, ReachesFurtherIntoTheLongTail) {
  // Mean 6, deviation 6, sum of cubes 2520: skewness g = 8 / 42 * 2520 / 216 = 20 / 9. With
  // x = 2.3646 / sqrt(8) = 0.836, the upper end is at its limit since 1.7 g x > 1: 6 + 6 * 3 x. The
  // lower one is 6 - 6 * 3 / (g / 2) * (cbrt(1 + g / 2 * z) - 1) with z = x - g / 2 / 48.
  const auto found = mean_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 20.0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->interval.low, 2.1240604125677827, 1e-9);
  EXPECT_NEAR(found->interval.high, 6.0 + 18.0 * 2.364624251592784 / std::sqrt(8.0), 1e-9);
}

TEST(MeanInterval, IsWiderTowardsAModeratelyLongTail) {
  // Mean 0, sum of squares 108, of cubes 180: deviation s = sqrt(108 / 7) and skewness
  // g = 8 / 42 * 180 / s^3 = 0.566. The upper end is s * 3 / (1.7 g) * (1 - cbrt(1 - 1.7 g x)), the
  // lower one as above; Student's are at -+3.284.
  const auto found = mean_interval(Numbers{-5.0, -4.0, -2.0, -1.0, 0.0, 2.0, 3.0, 7.0});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->interval.low, -3.0342935565577758, 1e-9);
  EXPECT_NEAR(found->interval.high, 5.1358944468583045, 1e-9);
}

TEST(MeanInterval, TurnsRoundWithItsValues) {
  Numbers x{0.3, 1.1, 0.7, 2.9, -0.4, 0.2, 0.9, 1.4};
  const auto found = mean_interval(x);
  for (double& value : x) value = -2.0 * value;
  const auto turned = mean_interval(x);
  EXPECT_NEAR(turned->interval.low, -2.0 * found->interval.high, 1e-12);
  EXPECT_NEAR(turned->interval.high, -2.0 * found->interval.low, 1e-12);
  EXPECT_NEAR(turned->p, found->p, 1e-12);
}

TEST(MeanInterval, ExcludesZeroExactlyWhereItsPIsAtMostTheRest) {
  Numbers x{0.9, 1.1, 0.7, 1.9, 0.4, 1.3, 0.8, 1.0};
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

TEST(MeanInterval, CoversNormalAndExponentialValues) {
  std::mt19937_64 bits(3);
  const auto uniform = [&] { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; };
  constexpr int kDraws = 20000;  // standard error 0.15 points
  int normal = 0;
  int exponential = 0;
  Numbers x(8);
  for (int i = 0; i < kDraws; ++i) {
    for (double& value : x) {
      value = std::sqrt(-2.0 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
    }
    const Interval a = mean_interval(x)->interval;
    normal += a.low <= 0.0 && 0.0 <= a.high ? 1 : 0;
    for (double& value : x) value = -std::log(uniform());
    const Interval b = mean_interval(x)->interval;
    exponential += b.low <= 1.0 && 1.0 <= b.high ? 1 : 0;
  }
  EXPECT_NEAR(normal / double{kDraws}, 0.96, 0.01);
  EXPECT_NEAR(exponential / double{kDraws}, 0.95, 0.01);  // 89.4 % without the correction
}

TEST(MeanInterval, HasFewerDegreesOfFreedomWithTies) {
  // Symmetric about 0 with sum of squares 58; six of twelve values differ from 0.
  const auto found =
      mean_interval(Numbers{-4.0, -3.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-12, 2.0, 3.0, 4.0});
  ASSERT_TRUE(found);
  const double half = student_quantile(0.05, 6) * std::sqrt(58.0 / 11.0 / 12.0);
  EXPECT_NEAR(found->interval.low, -half, 1e-9);
  EXPECT_NEAR(found->interval.high, half, 1e-9);
}

TEST(MeanInterval, CountsTiesOfManyValues) {
  Numbers x(4000, 0.0);
  for (std::size_t i = 0; i < 40; ++i) x[100 * i] = i % 2 == 0 ? 1.0 : -1.0;
  const double deviation = std::sqrt(40.0 / 3999.0);
  const double half = student_quantile(0.05, 40) * deviation / std::sqrt(4000.0);
  EXPECT_NEAR(mean_interval(x)->interval.high, half, 1e-12);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i) - 1999.5;
  EXPECT_NEAR(mean_interval(x)->p, 1.0, 1e-12);
}

TEST(MeanInterval, CoversTheMeanOfManyTies) {
  std::mt19937_64 bits(3);
  const auto uniform = [&] { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; };
  for (const double ties : {0.5, 0.75}) {
    int given = 0;
    int covers = 0;
    Numbers x(15);
    while (given < 10000) {  // standard error 0.25 points
      for (double& value : x) {
        const double normal =
            std::sqrt(-2.0 * std::log(uniform())) * std::cos(6.283185307179586 * uniform());
        value = uniform() < ties ? 0.0 : normal;
      }
      const auto found = mean_interval(x);
      if (!found) continue;
      ++given;
      covers += found->interval.low <= 0.0 && 0.0 <= found->interval.high ? 1 : 0;
    }
    EXPECT_NEAR(covers / double{10000}, 0.95, 0.02) << ties;  // 89 to 91 % with n - 1
  }
}

TEST(MeanInterval, IsNotGivenOfTooLittle) {
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}),
            "7 observations, 8 are needed");
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0}),
            "4 of 8 observations differ from the most frequent value, 5 must");
  EXPECT_EQ(why_no_interval(Numbers(9, 0.25)),
            "0 of 9 observations differ from the most frequent value, 5 must");
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 0.0, 0.0, 0.0}), "");
  EXPECT_FALSE(mean_interval(Numbers(9, 0.25)));
  EXPECT_FALSE(mean_interval(Numbers{}));
  EXPECT_THROW(mean_interval(Numbers(5, 1.0), 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace loopbench::mean_interval_test
