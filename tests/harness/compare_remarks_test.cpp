/// Remarks of comparisons, and statistics that have none.
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/compare/compare.hpp"
#include "tests/support/compared_sweep.hpp"
#include "tests/support/refusal_of.hpp"

namespace loopbench::compare_remarks_test {

using namespace methods;
using namespace metrics;
using namespace harness;

namespace {

using namespace compared_sweep;  // NOLINT: its records are what every test here is about

bool has_remark(const Comparison& c, const std::string& part) {
  return std::ranges::any_of(remarks(c), [&](const std::string& remark) {
    return remark.find(part) != std::string::npos;
  });
}

TEST(Compare, RejectsStatisticsWithoutADirection) {
  for (const std::string value : {"count", "sse"}) {
    EXPECT_EQ(refusal_of([&] { compare(sweep(), {.baseline = "raw", .value = value}); }),
              "value: '" + value +
                  "' depends on the number of errors: no value is better than another; expected "
                  "rmse, mean, median, p90, p95, p99, std, min or max");
  }
}

TEST(Compare, StatesItsTest) {
  EXPECT_TRUE(
      has_remark(compared(sweep()), "a failure being the largest loss, corrected for 2 tests"));
}

TEST(Compare, SaysWhereRanksAndTheMeanContradictEachOther) {
  std::vector<Record> records;  // 5 % better on 35 runs of 40, ten times as bad on five
  for (int i = 0; i < 40; ++i) {
    records.push_back(score("room", i, "raw", 1.0 + 0.1 * i));
    records.push_back(
        score("room", i, "risky", (1.0 + 0.1 * i) * (i < 5 ? 10.0 : 0.95 - 0.001 * i)));
  }
  const Comparison c = compared(records, {.baseline = "raw"});
  EXPECT_FALSE(c.is_best);
  EXPECT_LT(*c.methods[0].p, 0.05);
  EXPECT_NE(verdict(c).find("on most runs, but the geometric mean ratio is 1.2"), std::string::npos)
      << verdict(c);
  EXPECT_TRUE(has_remark(c, "risky: ranks and the geometric mean ratio to raw contradict"));
}

/// Sixteen seeds of four sequences: dual is 20 % below raw on one of them only.
std::vector<Record> one_of_four() {
  std::vector<Record> out;
  for (int seed = 0; seed < 16; ++seed) {
    for (const std::string sequence : {"room", "city", "hall", "sparse"}) {
      const double noise = 1.0 + 0.002 * ((seed * 7) % 16 - 7.5);
      out.push_back(score(sequence, seed, "raw", 1.0 + 0.1 * seed));
      out.push_back(score(sequence,
                          seed,
                          "dual",
                          (1.0 + 0.1 * seed) * noise * (sequence == "sparse" ? 0.8 : 0.999)));
    }
  }
  return out;
}

TEST(Sequences, ThatDifferAreInTheSentenceAndTheirDifferencesNotInTheInterval) {
  const Comparison c = compared(one_of_four(), {.baseline = "raw"});
  const std::string text = verdict(c);
  EXPECT_NE(text.find(", all of it on sparse (20.0 %), p = "), std::string::npos) << text;
  EXPECT_NE(text.find("; over 64 runs of 4 sequences"), std::string::npos) << text;
  EXPECT_TRUE(has_remark(c,
                         "mean ratio dual / raw by sequence: room 0.999, city 0.999, hall 0.999, "
                         "sparse 0.800"));
  const Interval& typical = c.methods[0].ratio->typical;
  EXPECT_NEAR(typical.estimate, std::exp(0.25 * std::log(0.8)), 0.004);
  EXPECT_LT(typical.high - typical.low, 0.015);
}

}  // namespace
}  // namespace loopbench::compare_remarks_test
