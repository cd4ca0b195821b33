/// Sentence, standings and ratios of random sweeps never contradict each other.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/answers/compare/verdict.hpp"
#include "tests/studies/synthetic_records.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::ranking_test {

using namespace harness;

namespace {

void expect_consistent(const Comparison& c) {
  const std::string text = verdict_of(c, {}).sentence;
  EXPECT_FALSE(c.methods.front().is_worse) << text;
  EXPECT_LE(std::ranges::count(text, ' ') + 1, 25) << text;
  bool has_worse = false;
  for (const MethodVerdict& m : c.methods) {
    has_worse = has_worse || m.is_worse;
    if (c.is_best && m.method == c.options.baseline && !m.is_worse) EXPECT_FALSE(m.beats_baseline);
    if (!m.p) continue;
    if (m.beats_baseline) EXPECT_LE(*m.p, c.options.alpha);
    if (!m.ratio || !m.ratio->has_interval) continue;
    const Interval& typical = m.ratio->typical;
    const bool has_one = typical.low < 1.0 && typical.high > 1.0;
    EXPECT_TRUE(typical.low <= typical.estimate && typical.estimate <= typical.high);
    EXPECT_EQ(has_one, *m.p > c.options.alpha && typical.low < typical.high) << text;
  }
  if (c.is_best) EXPECT_TRUE(has_worse) << text;
  const bool says_best =
      text.find(" is best") != std::string::npos || text.find(" are best") != std::string::npos;
  EXPECT_EQ(says_best && text.find("no method is best") == std::string::npos, c.is_best) << text;
}

TEST(Ranking, NeverContradictsItself) {
  std::mt19937_64 bits(3);
  int best = 0;
  for (const synthetic::Shape& shape : synthetic::shapes()) {
    for (int i = 0; i < 12; ++i) {
      synthetic::Truth truth{.effects = {0.0, -0.1 * i, -0.05, 0.2}, .groups = 16};
      if (i % 3 == 1) truth.failures = {0.0, 0.1, 0.2, 0.0};
      if (i % 3 == 2) truth.runs_in_group = 3;
      const Comparison c =
          compare(synthetic::records(truth, shape, bits), {.baseline = "m0"}).at(0);
      expect_consistent(c);
      best += c.is_best ? 1 : 0;
    }
  }
  EXPECT_GT(best, 10);
  EXPECT_LT(best, 100);
}

}  // namespace
}  // namespace loopbench::ranking_test
