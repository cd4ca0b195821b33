/// Cautions about sequences: significant or not, and the columns that show them.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/answers/compare/verdict.hpp"
#include "harness/answers/tables/comparison.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::compared_sweep::cautions_test {
namespace {

TEST(Cautions, NameTheSequenceOnWhichAMethodIsWorse) {
  std::vector<Record> records = one_of_four();
  for (Record& r : records) {
    if (r.cell->method == "dual" && r.cell->sequence == "city") r.statistics.rmse *= 1.1;
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  const Verdict v = verdict_of(c, {});
  EXPECT_TRUE(v.sentence.starts_with("ate, dense: dual is best, 3.2 % below raw (95 %: "))
      << v.sentence;
  ASSERT_EQ(v.cautions.size(), 1u);
  EXPECT_TRUE(has(v.cautions[0], "dual is 9.9 % worse than raw on city")) << v.cautions[0];
}

/// Four sequences; `swings` has `far` times the error of raw on half of them, `good` 20 % less.
std::vector<Record> swinging(int runs, double far) {
  std::vector<Record> out;
  for (int run = 0; run < runs; ++run) {
    for (const std::string sequence : {"a", "b", "c", "d"}) {
      const double size = 1.0 + 0.1 * run;
      const double noise = std::exp(0.3 * std::sin(1.0 + 2.4 * run + sequence[0]));
      out.push_back(score(sequence, run, "raw", size));
      out.push_back(score(sequence, run, "good", (0.8 + 0.001 * run) * size));
      out.push_back(
          score(sequence, run, "swings", (sequence < "c" ? far : 0.7 / far) * noise * size));
    }
  }
  return out;
}

TEST(Cautions, NameASequenceOnWhichAMethodOfTheFirstPlaceIsFarWorse) {
  const Comparison few = compared(swinging(3, 10.0), {.baseline = "raw"});
  ASSERT_FALSE(few.find("swings")->is_worse) << sentence(few);
  ASSERT_TRUE(few.find("raw")->is_worse) << sentence(few);
  const Verdict v = verdict_of(few, {});
  ASSERT_EQ(v.cautions.size(), 1u);  // three runs of a sequence show nothing about it
  EXPECT_TRUE(v.cautions[0].starts_with("swings is ")) << v.cautions[0];
  EXPECT_TRUE(v.cautions[0].ends_with(" % worse than raw on a (not significant)") ||
              v.cautions[0].ends_with(" % worse than raw on b (not significant)"))
      << v.cautions[0];
  const Verdict many = verdict_of(compared(swinging(16, 10.0), {.baseline = "raw"}), {});
  ASSERT_FALSE(many.cautions.empty());
  EXPECT_FALSE(has(many.cautions[0], "not significant")) << many.cautions[0];
}

TEST(Cautions, KeepTheColumnsOfTheirSequences) {
  std::vector<Record> records;
  for (int run = 0; run < 16; ++run) {
    for (char s = 'a'; s < 'a' + 9; ++s) {
      const double factor =
          s == 'e' ? 1.1 : 0.3;  // worse on one, by less than it is better on others
      records.push_back(score(std::string(40, s), run, "raw", 1.0 + 0.1 * run));
      records.push_back(score(
          std::string(40, s), run, "dual", factor * (1.0 + 0.001 * s) * (1.0 + 0.1002 * run)));
    }
  }
  const Verdict v = verdict_of(compared(records, {.baseline = "raw"}), {});
  ASSERT_EQ(v.cautions.size(), 1u);
  EXPECT_EQ(v.cautioned, std::vector<std::string>{std::string(40, 'e')});
  EXPECT_EQ(verdict_table(v).headings.back(), std::string(40, 'e'));
  EXPECT_EQ(verdict_table(v, 20).headings.size(), 4u);  // one is always shown
}

}  // namespace
}  // namespace loopbench::compared_sweep::cautions_test
