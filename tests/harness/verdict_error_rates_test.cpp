/// A short form of tests/studies/verdict_error_rates: error rates and coverage with known truth.
#include <gtest/gtest.h>

#include "tests/studies/error_rates.hpp"

namespace loopbench::synthetic {
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

TEST(IntervalCoverage, IsNominalFromFiveObservationsOn) {
  for (const Shape& shape : shapes()) {
    for (const std::size_t n : {5u, 8u, 15u}) {
      const Truth truth{.effects = {0.0, -0.2}, .groups = n, .baseline_is_fixed = true};
      const Coverage found = coverage(truth, shape, kRepeats, 11);
      EXPECT_GE(found.covered, 0.93 - 4.0 * 0.0233) << shape.name << " " << n;
    }
  }
}

}  // namespace
}  // namespace loopbench::synthetic
