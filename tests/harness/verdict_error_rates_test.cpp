/// A short form of tests/studies/verdict_error_rates: error rates and coverage with known truth.
#include <gtest/gtest.h>

#include "tests/studies/error_rates.hpp"

namespace loopbench::synthetic::verdict_error_rates_test {

using namespace harness;

namespace {

constexpr int kRepeats = 120;
// 5 % and four standard errors of so few repeats.
constexpr double kLimit = 0.05 + 4.0 * 0.0199;

void expect_few_errors(const Truth& truth) {
  for (const Shape& shape : shapes()) {
    EXPECT_LE(error_rates(truth, shape, kRepeats, 11).largest(), kLimit) << shape.name;
  }
}

TEST(VerdictErrorRates, AreLowForEqualMethods) {
  expect_few_errors({.effects = {0.0, 0.0}, .groups = 8});
  expect_few_errors({.effects = {0.0, -0.3, -0.3, 0.1}, .groups = 12});
}

TEST(VerdictErrorRates, AreLowForSequences) {
  expect_few_errors({.effects = {0.0, 0.0, 0.0}, .groups = 24, .sequences = {3, {0.0, 0.0, 0.0}}});
  const std::vector<double> zero(3, 0.0);
  expect_few_errors({.effects = {0.0, 0.0, 0.2}, .groups = 16, .sequences = {2, zero}});
}

TEST(VerdictErrorRates, AreLowForIndependentRuns) {
  expect_few_errors({.effects = {0.0, 0.0},
                     .groups = 16,
                     .sequences = {{0.0, 0.0}, {0.0, 0.0}},
                     .is_independent = true});
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
  EXPECT_GT(error_rates(truth, shapes()[0], kRepeats, 11).best, 0.2);
}

TEST(VerdictErrorRates, AreLowForCopiesAndFailures) {
  expect_few_errors({.effects = {0.0, 0.0}, .groups = 8, .copies = 1.0});
  expect_few_errors({.effects = {0.0, 0.0, 0.0}, .groups = 15, .failures = {0.0, 0.1, 0.3}});
}

TEST(VerdictErrorRates, LeaveRealDifferencesToBeFound) {
  const Truth truth{.effects = {0.0, -0.5, 0.0, 0.1}, .groups = 20};
  EXPECT_GT(error_rates(truth, shapes()[0], kRepeats, 11).found, 0.9);
  Truth close{.effects = {0.0, -0.22, 0.0, 0.0}, .groups = 15};
  const ErrorRates rates = error_rates(close, shapes()[0], 4 * kRepeats, 11);
  EXPECT_GE(rates.found, rates.holm);  // at least that of Holm's correction over the rivals
}

TEST(VerdictErrorRates, AreLowForLoneAndFrequentFailures) {
  const Truth lone{
      .effects = {0.0, -0.69}, .groups = 8, .runs_in_group = 20, .failures = {0.0, 0.05}};
  const ErrorRates rates = error_rates(lone, shapes()[0], 20, 11);
  EXPECT_GT(rates.claimed, 0.5);  // no claim where it is shown to fail more often
  EXPECT_LT(rates.found, 0.1);    // it fails on runs that the other one solves
  const Truth hard{.effects = {0.0, 0.18}, .groups = 20, .hard = 0.33, .fails_hard = 1.0};
  // Failures have no number: only the runs that both solve show the difference.
  EXPECT_GT(error_rates(hard, shapes()[0], kRepeats, 11).found, 0.25);
}

TEST(IntervalCoverage, IsNominalFromSixObservationsOn) {
  for (const Shape& shape : shapes()) {
    for (const std::size_t n : {6u, 15u}) {
      const IntervalCoverage found =
          coverage({.effects = {0.0, -0.2}, .groups = n}, shape, 500, 11);
      EXPECT_GE(found.covered, 0.95 - 4.0 * 0.0097) << shape.name << " " << n;
      EXPECT_EQ(found.declined, 0.0) << shape.name << " " << n;
    }
    EXPECT_EQ(coverage({.effects = {0.0, -0.2}, .groups = 5}, shape, 10, 11).declined, 1.0);
  }
  // Ties make the true value an end of the interval, which holds it.
  EXPECT_GE(coverage({.effects = {0.0, -0.2}, .groups = 6}, shapes().back(), 1000, 12).covered,
            0.94);
  const Truth simultaneous{.effects = {0.0, -0.2, 0.1, 0.0, 0.3}, .groups = 12};
  EXPECT_GE(coverage(simultaneous, shapes()[0], 500, 11).covered, 0.95 - 4.0 * 0.0097);
}

TEST(IntervalCoverage, IsNominalWhereSequencesDifferInScatter) {
  const Truth truth{.effects = {0.0, -0.2},
                    .groups = 32,
                    .sequences = {{0.0, -0.3}, {0.0, 0.0}, {0.0, 0.1}, {0.0, 0.2}},
                    .dispersions = {1.0, 0.2, 0.2, 0.2}};
  EXPECT_GE(coverage(truth, shapes()[0], 500, 11).covered, 0.95 - 4.0 * 0.0097);
}

}  // namespace
}  // namespace loopbench::synthetic::verdict_error_rates_test
