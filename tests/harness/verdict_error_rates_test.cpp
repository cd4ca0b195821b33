/// A short form of tests/studies/verdict_error_rates: error rates and coverage with known truth.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/error_rates.hpp"

namespace loopbench::synthetic::verdict_error_rates_test {

using namespace metrics;
using namespace harness;

namespace {

constexpr int kRepeats = 120;
// 5 % and four standard errors of so few repeats.
constexpr double kLimit = 0.05 + 4.0 * 0.0199;

void expect_few_errors(const Truth& truth) {
  for (const Shape& shape : shapes()) {
    const ErrorRates rates = error_rates(truth, shape, kRepeats, 11);
    EXPECT_LE(rates.false_best, kLimit) << shape.name;
    EXPECT_LE(rates.marked_wrong, kLimit) << shape.name;
  }
}

TEST(VerdictErrorRates, AreLowForEqualMethods) {
  expect_few_errors({.effects = {0.0, 0.0}, .groups = 8});
  expect_few_errors({.effects = {0.0, -0.3, -0.3, 0.1}, .groups = 12});
}

TEST(VerdictErrorRates, AreLowForClusters) {
  expect_few_errors({.effects = {0.0, 0.0}, .groups = 8, .runs_in_group = 5, .shared = 0.75});
}

TEST(VerdictErrorRates, AreHighWhereClustersAreNotStated) {
  const Truth truth{.effects = {0.0, 0.0},
                    .groups = 8,
                    .runs_in_group = 5,
                    .shared = 0.75,
                    .states_groups = false};
  EXPECT_GT(error_rates(truth, shapes()[0], kRepeats, 11).false_best, 0.2);
}

TEST(VerdictErrorRates, AreLowForCopiesAndFailures) {
  expect_few_errors({.effects = {0.0, 0.0}, .groups = 8, .copies = 1.0});
  expect_few_errors({.effects = {0.0, 0.0, 0.0}, .groups = 15, .failures = {0.0, 0.1, 0.3}});
}

TEST(VerdictErrorRates, LeaveRealDifferencesToBeFound) {
  const Truth truth{.effects = {0.0, -0.5, 0.0, 0.1}, .groups = 20};
  EXPECT_GT(error_rates(truth, shapes()[0], kRepeats, 11).found, 0.9);
}

TEST(IntervalCoverage, IsNominalFromEightObservationsOn) {
  for (const Shape& shape : shapes()) {
    const bool has_ties = shape.name == "half ties";
    for (const std::size_t n : {8u, 15u}) {
      const Truth truth{.effects = {0.0, -0.2}, .groups = n, .baseline_is_fixed = true};
      const IntervalCoverage found = coverage(truth, shape, 1000, 11);
      const double error = 0.0081 / std::sqrt(1.0 - found.declined);
      EXPECT_GE(found.covered, 0.93 - 4.0 * error) << shape.name << " " << n;
      EXPECT_LE(found.covered, (has_ties ? 0.98 : 0.97) + 4.0 * error) << shape.name << " " << n;
      EXPECT_TRUE(has_ties || found.declined == 0.0) << shape.name << " " << n;
    }
    const Truth few{.effects = {0.0, -0.2}, .groups = 7, .baseline_is_fixed = true};
    EXPECT_EQ(coverage(few, shape, 10, 11).declined, 1.0);
  }
}

TEST(SyntheticStores, AreReadAsTheyWereDrawn) {
  const Truth truth{.effects = {0.0, -0.2, 0.1},
                    .groups = 8,
                    .runs_in_group = 2,
                    .failures = {0.0, 0.0, 0.2},
                    .copies = 0.3};
  const ErrorRates drawn = error_rates(truth, shapes()[0], 20, 11, Through::memory);
  const ErrorRates read = error_rates(truth, shapes()[0], 20, 11, Through::store);
  EXPECT_EQ(drawn.found, read.found);
  EXPECT_EQ(drawn.false_better, read.false_better);
  EXPECT_EQ(drawn.marked_wrong, read.marked_wrong);
  EXPECT_EQ(coverage(truth, shapes()[0], 20, 11).covered,
            coverage(truth, shapes()[0], 20, 11, Through::store).covered);
}

}  // namespace
}  // namespace loopbench::synthetic::verdict_error_rates_test
