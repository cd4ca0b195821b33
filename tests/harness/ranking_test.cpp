/// Sentence, letters, ranks, ratios and marks of random sweeps never contradict each other.
#include "harness/compare/ranking.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/tables/pivot.hpp"
#include "tests/studies/synthetic_records.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::ranking_test {

using namespace methods;
using namespace harness;

namespace {

bool share_letter(const MethodVerdict& a, const MethodVerdict& b) {
  return a.letters.find_first_of(b.letters) != std::string::npos;
}

void expect_consistent(const Comparison& c, const std::vector<Record>& records) {
  const MethodVerdict& first = c.methods.front();
  const std::string text = verdict(c);
  for (const MethodVerdict& m : c.methods) {
    EXPECT_LE(m.lowest_rank, m.highest_rank);
    EXPECT_EQ(m.is_leader || m.is_beaten_by_leader ? false : c.is_best_proven, false) << text;
    EXPECT_EQ(m.is_beaten_by_leader, !share_letter(first, m)) << text;
    if (!m.p) continue;
    const auto baseline = std::ranges::find(c.methods, c.options.baseline, &MethodVerdict::method);
    EXPECT_EQ(*m.p <= c.options.alpha, !share_letter(m, *baseline)) << text;
    if (!m.beats_baseline) continue;
    EXPECT_LE(*m.p, c.options.alpha);
    EXPECT_TRUE(!m.ratio || m.ratio->estimate < 1.0) << text;
    EXPECT_TRUE(!m.has_interval || m.ratio->high < 1.0) << text;
  }
  for (std::size_t i = 0; i < c.methods.size(); ++i) {
    for (std::size_t j = i + 1; j < c.methods.size(); ++j) {
      if (share_letter(c.methods[i], c.methods[j])) continue;
      EXPECT_GT(c.methods[j].lowest_rank, 1u) << "claims follow the order: " << text;
    }
  }
  EXPECT_EQ(c.is_best_proven && !first.is_leader, false);
  EXPECT_EQ(
      text.find(" is best") != std::string::npos && text.find("proven best") == std::string::npos,
      c.is_best_proven)
      << text;
  const Table table = pivot(records, TableSpec{.split = {"times"}, .show = {}, .where = {}}).at(0);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const bool is_marked = table.entries[row][0].mark == Mark::best;
    EXPECT_EQ(is_marked, c.is_best_proven && first.method == table.rows[row]) << text;
  }
}

TEST(Ranking, NeverContradictsItself) {
  std::mt19937_64 bits(3);
  int proven = 0;
  for (const synthetic::Shape& shape : synthetic::shapes()) {
    for (int i = 0; i < 12; ++i) {
      synthetic::Truth truth{.effects = {0.0, -0.1 * i, -0.05, 0.2}, .groups = 16};
      if (i % 3 == 1) truth.failures = {0.0, 0.1, 0.2, 0.0};
      if (i % 3 == 2) truth.runs_in_group = 3;
      const std::vector<Record> records = synthetic::records(truth, shape, bits);
      const Comparison c = compare(records, {.baseline = "m0"}).at(0);
      expect_consistent(c, records);
      proven += c.is_best_proven ? 1 : 0;
    }
  }
  EXPECT_GT(proven, 10);
  EXPECT_LT(proven, 80);
}

/// "ab", "b", ...: letters of methods in order, given who beats whom.
std::vector<std::string> letters_of(std::size_t count,
                                    const std::vector<std::pair<int, int>>& claims) {
  Ranking ranking;
  ranking.beats.assign(count, std::vector<bool>(count));
  for (std::size_t m = 0; m < count; ++m) ranking.order.push_back(m);
  for (const auto& [better, worse] : claims) {
    ranking.beats[static_cast<std::size_t>(better)][static_cast<std::size_t>(worse)] = true;
  }
  return letters(ranking);
}

TEST(Letters, AreSharedExactlyByMethodsThatAreNotProvenDifferent) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(letters_of(3, {}), (Texts{"a", "a", "a"}));
  EXPECT_EQ(letters_of(3, {{0, 1}, {0, 2}}), (Texts{"a", "b", "b"}));
  EXPECT_EQ(letters_of(3, {{0, 2}}), (Texts{"a", "ab", "b"}));
  EXPECT_EQ(letters_of(4, {{0, 2}, {1, 3}}), (Texts{"ab", "ac", "cd", "bd"}));
}

}  // namespace
}  // namespace loopbench::ranking_test
