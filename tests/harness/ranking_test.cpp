/// Sentence, standings and ratios of random sweeps never contradict each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "harness/answers/compare/verdict.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "tests/studies/synthetic_records.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/contradictions.hpp"

namespace loopbench::ranking_test {

using namespace harness;

namespace {

void expect_consistent(const Comparison& c) {
  const std::string text = verdict_of(c, {}).sentence;
  EXPECT_FALSE(c.methods.front().is_worse) << text;
  EXPECT_LE(std::ranges::count(text, ' ') + 1, 30) << text;
  EXPECT_EQ(text.find("inf"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  bool has_worse = false;
  for (const MethodVerdict& m : c.methods) {
    has_worse = has_worse || m.is_worse;
    EXPECT_FALSE(m.method == c.options.baseline && m.beats_baseline);
    if (!m.p) continue;
    EXPECT_TRUE(!m.beats_baseline || *m.p <= c.options.alpha);
    if (!m.ratio || !m.ratio->has_interval) continue;
    const Interval& typical = m.ratio->typical;
    const bool has_one = typical.low <= 1.0 && typical.high >= 1.0;
    EXPECT_TRUE(typical.low <= typical.estimate && typical.estimate <= typical.high);
    EXPECT_TRUE(m.method == c.options.baseline || has_one == (*m.p > c.options.alpha)) << text;
  }
  EXPECT_TRUE(has_worse || !c.is_best) << text;
  const bool says_best =
      text.find(" is best") != std::string::npos || text.find(" are best") != std::string::npos;
  EXPECT_EQ(says_best && text.find("no method is best") == std::string::npos, c.is_best) << text;
}

void expect_places_to_have_other_numbers(const Comparison& c) {
  std::set<std::string> first, worse;
  for (const auto& line : verdict_table(verdict_of(c, {})).lines)
    (line[0].text.starts_with("> ") ? worse : first).insert(line[1].text);
  for (const std::string& change : first) EXPECT_FALSE(worse.contains(change)) << change;
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

TEST(Ranking, HasNumbersThatItsSentenceDoesNotContradict) {
  std::mt19937_64 bits(4);
  for (const synthetic::Shape& shape : synthetic::shapes()) {
    for (int i = 0; i < 60; ++i) {
      synthetic::Truth truth{.effects = {0.0, -0.1 * (i % 5), -0.02 * (i % 7)},
                             .groups = std::size_t(3 + i % 17)};
      if (i % 3 == 0) truth.effects.resize(2);
      if (i % 4 > 1) truth.sequences = {{0.0, -0.4, 0.1}, {0.0, 0.3, -0.1}, {0.0, 0.1, 0.0}};
      if (i % 4 == 3) truth.dispersions = {1.0, 0.1, 0.1};
      if (i % 5 > 2) truth.failures = {0.1, 0.3, 0.0};
      truth.is_independent = i % 6 == 5 && i % 4 > 1;
      const std::vector<Comparison> all =
          compare(synthetic::records(truth, shape, bits), {.baseline = "m0"});
      const auto c = nlohmann::json::parse(json(all)).at(0);
      EXPECT_EQ(contradictions(c), std::vector<std::string>{}) << c.dump(1);
      if (truth.failures.empty()) expect_places_to_have_other_numbers(all[0]);
    }
  }
}

}  // namespace
}  // namespace loopbench::ranking_test
