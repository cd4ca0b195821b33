/// Worked intervals, agreement with p, coverage, and where no interval is given.
#include "harness/statistics/mean_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
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

TEST(MeanInterval, IsSlightlyNarrowerThanStudentsWhereValuesAreSymmetric) {
  const auto found = mean_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  ASSERT_TRUE(found);
  const double factor = 1.0 - 10.0 / 64.0;
  const double half = factor * 2.364624251592784 * std::sqrt(6.0 / 8.0);  // variance 6
  EXPECT_DOUBLE_EQ(found->interval.estimate, 4.5);
  EXPECT_NEAR(found->interval.low, 4.5 - half, 1e-12);
  EXPECT_NEAR(found->interval.high, 4.5 + half, 1e-12);
  EXPECT_NEAR(found->p, student_p(4.5 / (factor * std::sqrt(0.75)), 7), 1e-14);
}

TEST(MeanInterval, ReachesFurtherIntoTheLongTail) {
  // Mean 6, deviation 6, sum of cubes 2520: skewness g = 8 / 42 * 2520 / 216 = 20 / 9, which over
  // sqrt(8) is 0.786 > 0.39 - 1.2 / 8.
  const auto found = mean_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 20.0});
  ASSERT_TRUE(found);
  const double student = 6.0 * 2.364624251592784 / std::sqrt(8.0);
  EXPECT_NEAR(found->interval.low, 6.0 - student, 1e-9);
  EXPECT_NEAR(found->interval.high, 6.0 + 3.5 * student, 1e-9);
}

TEST(MeanInterval, IsWiderTowardsAModeratelyLongTail) {
  // Mean 0, sum of squares 108, of cubes 180: deviation s = sqrt(108 / 7) and skewness
  // g = 8 / 42 * 180 / s^3. Over sqrt(8) that is 0.200, between 0.14 and 0.24.
  const auto found = mean_interval(Numbers{-5.0, -4.0, -2.0, -1.0, 0.0, 2.0, 3.0, 7.0});
  ASSERT_TRUE(found);
  const double deviation = std::sqrt(108.0 / 7.0);
  const double student = deviation * 2.364624251592784 / std::sqrt(8.0);
  const double of_mean = 8.0 / 42.0 * 180.0 / std::pow(deviation, 3) / std::sqrt(8.0);
  const double skewed = (of_mean - 0.14) / 0.1;
  const double symmetric = 1.0 - 10.0 / 64.0;
  EXPECT_NEAR(found->interval.low, -student * std::lerp(symmetric, 1.0, skewed), 1e-9);
  EXPECT_NEAR(found->interval.high, student * std::lerp(symmetric, 3.5, skewed), 1e-9);
  EXPECT_NEAR(skewed, 0.6, 0.01);
}

TEST(MeanInterval, ReachesLessFarWithTies) {
  // Deviations from the mean 1: nine of -1, then 2, 3 and 4, so that the sum of squares is 38, of
  // cubes 90 and the skewness over sqrt(12) clearly above 0.29. Three quarters are ties.
  const Numbers few{0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 3.0, 4.0, 5.0};
  const Numbers third{0.0, 0.0, 0.0, 0.0, 0.04, 0.05, 0.06, 0.07, 0.08, 3.0, 4.0, 5.0};
  const auto ratio = [](const Interval& x) { return (x.high - x.estimate) / (x.estimate - x.low); };
  EXPECT_NEAR(ratio(mean_interval(few)->interval), 3.5, 1e-9);
  EXPECT_NEAR(ratio(mean_interval(third)->interval), 1.5, 1e-9);
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

/// Random numbers that do not depend on the standard library.
class Draws {
 public:
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  double exponential() { return -std::log(uniform()); }
  double normal() { return std::sqrt(2.0 * exponential()) * std::cos(2.0 * M_PI * uniform()); }

 private:
  std::mt19937_64 bits_{3};
};

/// Share of 20000 intervals (or of those given) that contain `truth`; standard error 0.15 points.
double covered(std::size_t n, double truth, const std::function<double(Draws&)>& draw) {
  Draws draws;
  Numbers x(n);
  int given = 0;
  int covers = 0;
  for (int i = 0; i < 20000; ++i) {
    for (double& value : x) value = draw(draws);
    const auto found = mean_interval(x);
    if (!found) continue;
    ++given;
    covers += found->interval.low <= truth && truth <= found->interval.high ? 1 : 0;
  }
  return covers / static_cast<double>(given);
}

TEST(MeanInterval, CoversWithinTwoPointsOf95) {
  for (const std::size_t n : {8u, 10u, 15u, 20u, 30u}) {
    SCOPED_TRACE(n);
    EXPECT_NEAR(covered(n, 0.0, [](Draws& d) { return d.normal(); }), 0.95, 0.02);
    EXPECT_NEAR(covered(n, 0.5, [](Draws& d) { return d.uniform(); }), 0.95, 0.02);
    EXPECT_NEAR(covered(n, 1.0, [](Draws& d) { return d.exponential(); }), 0.95, 0.02);
    EXPECT_NEAR(
        covered(n, std::exp(0.5), [](Draws& d) { return std::exp(d.normal()); }), 0.95, 0.02);
  }
}

TEST(MeanInterval, CoversTheMeanOfManyTiesWithinTwoPoints) {
  const auto normal = [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.normal(); };
  const auto exponential = [](Draws& d) { return d.uniform() < 0.5 ? 0.0 : d.exponential(); };
  for (const std::size_t n : {10u, 15u, 30u}) {
    SCOPED_TRACE(n);
    EXPECT_NEAR(covered(n, 0.0, normal), 0.95, 0.02);
    EXPECT_NEAR(covered(n, 0.5, exponential), 0.95, 0.02);
  }
}

TEST(MeanInterval, CountsTiesOfManyValues) {
  Numbers x(4000, 0.0);
  for (std::size_t i = 0; i < 40; ++i) x[100 * i] = i % 2 == 0 ? 1.0 : -1.0;
  const double deviation = std::sqrt(40.0 / 3999.0);
  const double half = student_quantile(0.05, 3999) * deviation / std::sqrt(4000.0);
  EXPECT_NEAR(mean_interval(x)->interval.high, half, 1e-8);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i) - 1999.5;
  EXPECT_NEAR(mean_interval(x)->p, 1.0, 1e-12);
}

TEST(MeanInterval, IsNotGivenOfTooLittle) {
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}),
            "7 observations, 8 are needed");
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0}),
            "4 of 8 observations differ from the most frequent value, 5 must");
  EXPECT_EQ(why_no_interval(Numbers(9, 0.25)),
            "0 of 9 observations differ from the most frequent value, 5 must");
  EXPECT_EQ(why_no_interval(Numbers{1.0, 2.0, 3.0, 4.0, 5.0, 0.0, 0.0, 0.0}), "");
  Numbers twenty(20, 0.0);
  for (std::size_t i = 0; i < 7; ++i) twenty[i] = static_cast<double>(1 + i * i);
  EXPECT_EQ(why_no_interval(twenty),
            "7 of 20 observations differ from the most frequent value, 8 must");
  EXPECT_FALSE(mean_interval(twenty));
  twenty[7] = 0.5;
  EXPECT_EQ(why_no_interval(twenty), "");
  EXPECT_FALSE(mean_interval(Numbers(9, 0.25)));
  EXPECT_FALSE(mean_interval(Numbers{}));
  EXPECT_THROW(mean_interval(Numbers(5, 1.0), 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace loopbench::mean_interval_test
