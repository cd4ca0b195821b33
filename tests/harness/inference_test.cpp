/// Statistical tests compared with enumerations, tables and R.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/answers/compare/exchanges.hpp"
#include "harness/answers/compare/randomization.hpp"
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

TEST(Average, IsWhatItsNameSays) {
  EXPECT_DOUBLE_EQ(mean(Numbers{1.0, 2.0, 6.0}), 3.0);
  EXPECT_DOUBLE_EQ(sample_deviation(Numbers{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}),
                   std::sqrt(32.0 / 7.0));
  EXPECT_THROW(mean(Numbers{}), std::invalid_argument);
  EXPECT_THROW(sample_deviation(Numbers{1.0}), std::invalid_argument);
}

TEST(Normal, AgreesWithItsTables) { EXPECT_NEAR(normal_cdf(1.959963984540054), 0.975, 1e-15); }

TEST(Student, AgreesWithItsTables) {
  EXPECT_NEAR(student_two_sided(12.706, 1.0), 0.05, 1e-5);
  EXPECT_NEAR(student_two_sided(2.228, 10.0), 0.05, 1e-4);
  EXPECT_NEAR(student_two_sided(0.6998, 10.0), 0.5, 1e-4);
  EXPECT_NEAR(student_two_sided(3.5, 1e7), 2.0 * normal_cdf(-3.5), 1e-8);
  EXPECT_EQ(student_two_sided(0.0, 3.0), 1.0);
  double last = 1.0;
  for (double degrees = 1.0; degrees < 40.0; degrees += 0.3) {
    const double p = student_two_sided(2.0, degrees);
    EXPECT_LT(p, last);
    last = p;
  }
}

/// Share of the sums of all signs that are at least `least`.
double enumerated(const Numbers& sizes, double least) {
  double count = 0.0;
  for (std::size_t signs = 0; signs < std::size_t{1} << sizes.size(); ++signs) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      sum += (signs >> i & 1) != 0 ? sizes[i] : -sizes[i];
    count += sum >= least ? 1.0 : 0.0;
  }
  return count / std::exp2(static_cast<double>(sizes.size()));
}

TEST(Exchanges, AreAllCounted) {
  const Numbers sizes{1.0, 2.5, 3.0, 4.0, 4.0, 0.5, 7.0};
  std::vector<Term> terms;
  for (const double size : sizes) terms.push_back({size, -size});
  for (const double least : {-3.0, 0.0, 2.0, 9.5, 22.0, 23.0})
    EXPECT_DOUBLE_EQ(tail_of_terms(terms, least), enumerated(sizes, least)) << least;
}

TEST(Exchanges, OfManySignsAreApproximated) {
  Numbers sizes;
  for (int i = 0; i < 18; ++i) sizes.push_back(1.0 + std::fmod(0.618 * i, 1.0));
  for (const double least : {3.0, 8.0, 13.0, 18.0}) {
    const double exact = enumerated(sizes, least);
    EXPECT_NEAR(tail_of_signs(sizes, least), exact, 0.05 * exact) << least;
  }
}

double p_of(const Numbers& pairs) { return RandomizationTest({Stratum{pairs}}).p(); }

TEST(Randomization, CountsTheSignsThatAreAsFar) {
  EXPECT_DOUBLE_EQ(p_of({1, 2, 3, 4, 5, 6}), 2.0 / 64.0);  // the smallest of six values
  EXPECT_DOUBLE_EQ(RandomizationTest({{{1, 2, 3, 4, 5, 6}}}).least_p(), 2.0 / 64.0);
  // +-1 +-2 +-3 +-4 is at least 2 for seven of sixteen patterns.
  EXPECT_DOUBLE_EQ(p_of({1, 2, 3, -4}), 14.0 / 16.0);
  EXPECT_EQ(p_of({1, 2, -3, -1, -2, 3}), 1.0);
  EXPECT_EQ(p_of({0, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(p_of({0, 1, 2, 0, 3, 4, 5, 6}), 2.0 / 64.0);  // ties have no sign
  EXPECT_DOUBLE_EQ(least_p_of(6, 0), 2.0 / 64.0);
}

TEST(Randomization, CountsTheLabelsOfSamples) {
  const RandomizationTest apart({{{1, 2, 3}, {4, 5, 6}}});
  EXPECT_DOUBLE_EQ(apart.p(), 2.0 / 20.0);
  EXPECT_NEAR(apart.least_p(), 2.0 / 20.0, 1e-12);
  EXPECT_NEAR(least_p_of(3, 1), 2.0 / 20.0, 1e-12);
  // {1, 2, 4} and {3, 5, 6}: of twenty choices two have a difference of sums of 7 or more.
  EXPECT_DOUBLE_EQ(RandomizationTest({{{1, 2, 4}, {3, 5, 6}}}).p(), 4.0 / 20.0);
  EXPECT_EQ(RandomizationTest({{{1, 2}, {1, 2}}}).p(), 1.0);
}

TEST(Randomization, IsNotDecidedByOutliers) {
  Numbers values{0.30, 0.31, 0.29, 0.32, 0.28, 0.33, 0.27, 0.34, 0.26, 0.35, 0.25, 0.36};
  const double before = p_of(values);
  values[3] = 40.0;
  EXPECT_DOUBLE_EQ(p_of(values), before);
  values[3] = -40.0;  // one sign of twelve
  EXPECT_LT(p_of(values), 0.05);
  EXPECT_GT(p_of(values), before);
}

TEST(Randomization, OfStrataIsAboutTheirMean) {
  // Three sequences are slightly worse, one is better by three times as much, with more scatter.
  Stratum noisy, slight;
  for (int i = 0; i < 16; ++i) {
    const double scatter = std::sin(1.0 + 2.4 * i);
    noisy.first.push_back(-0.45 + 1.2 * scatter);
    slight.first.push_back(0.15 + 0.1 * scatter);
  }
  const RandomizationTest test({noisy, slight, slight, slight});
  EXPECT_NEAR(test.typical(), 0.0, 0.05);
  EXPECT_GT(test.p(), 0.3);
  EXPECT_LT(RandomizationTest({slight, slight}).p(), 1e-6);
  // One value of a sequence decides no sign of the mean.
  EXPECT_GT(RandomizationTest({{{0.01, 0.011, 0.012}}, {{-1.0, 0.2, -2.0}}}).p(), 0.2);
}

TEST(Randomization, HasTheIntervalThatInvertsIt) {
  std::size_t shown = 0;
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<Stratum> strata(1 + static_cast<std::size_t>(draw % 3));
    for (std::size_t i = 0; i < 14 * strata.size(); ++i) {
      const double x = std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * draw) * 43758.5453;
      strata[i % strata.size()].first.push_back(x - std::floor(x) - 0.3);
    }
    const RandomizationTest test(strata);
    const auto found = test.interval(0.05);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->estimate, test.typical());
    EXPECT_TRUE(found->low <= found->estimate && found->estimate <= found->high);
    EXPECT_EQ(test.p() <= 0.05, found->low > 0.0 || found->high < 0.0) << draw;
    EXPECT_LE(test.p(found->low - 1e-3), 0.06);
    EXPECT_GT(test.p(found->low + 1e-3), 0.04);
    shown += test.p() <= 0.05 ? 1 : 0;
  }
  EXPECT_TRUE(shown > 20 && shown < 180) << shown;
  EXPECT_FALSE(RandomizationTest({{{1, 2, 3, 4, 5}}}).interval(0.05));
}

TEST(TypicalDifference, IsTheMedianOfMeansOfTwo) {
  // Means of {1, 2, 6}: 1, 1.5, 2, 3.5, 4, 6.
  const Numbers values{1.0, 2.0, 6.0};
  EXPECT_EQ(pseudo_median(values), 2.75);
  const Numbers sorted{1.0, 1.5, 2.0, 3.5, 4.0, 6.0};
  for (std::size_t k = 1; k <= 6; ++k) EXPECT_EQ(walsh_average(values, k), sorted[k - 1]);
  // R: wilcox.test(x, y, paired = TRUE, conf.int = TRUE) on the depression scores of Hollander and
  // Wolfe, 3.1, has the estimate 0.46.
  const Numbers x{1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const Numbers y{0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  EXPECT_NEAR(typical_of({differences(x, y)}), 0.46, 1e-9);
  EXPECT_EQ(typical_of({{1.0, 2.0}, {0.0, 5.0, 7.0}}), -3.5);  // 1 2 -4 -3 -6 -5
}

}  // namespace
}  // namespace loopbench::inference_test
