/// Power of the comparison against values of tables and of simulation.
#include "harness/compare/power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/model/recorded_run.hpp"
#include "harness/tables/comparison.hpp"
#include "tests/support/compared_sweep.hpp"

namespace loopbench::power_test {

using namespace harness;

namespace {

TEST(Power, IsThatOfTheTest) {
  Power power(0.05);
  EXPECT_TRUE(std::isinf(power.smallest_effect(5)));  // five signs have p = 0.0625
  // Student's t needs 1.16 for 8 and 0.45 for 41 values; the rank test a little more.
  EXPECT_NEAR(power.smallest_effect(8), 1.2, 0.1);
  EXPECT_NEAR(power.smallest_effect(41), 0.46, 0.02);
  // (1.960 + 0.842) / sqrt(3 / pi * 400)
  EXPECT_NEAR(power.smallest_effect(400), 0.1434, 1e-4);
  EXPECT_NEAR(power.smallest_effect(200), power.smallest_effect(201), 0.01);
}

TEST(Power, NeedsMoreGroupsForLess) {
  Power power(0.05 / 6.0);
  EXPECT_EQ(power.groups_needed(10.0), 8u);  // 2^-7 is 0.0078
  const std::size_t groups = power.groups_needed(0.5);
  EXPECT_LE(power.smallest_effect(groups), 0.5);
  EXPECT_GT(power.smallest_effect(groups - 1), 0.5);
  EXPECT_EQ(power.groups_needed(1e-6), Power::kMostGroups);
}

TEST(Power, OfIndependentRunsIsThatOfRankSums) {
  Power power(0.05, 1);
  EXPECT_TRUE(std::isinf(power.smallest_effect(3)));  // p = 0.1
  // 64 runs of either system find 0.5 standard deviations with 80 % (Lehmann 1975), which are 0.354
  // of the difference of two runs; rank sums need 5 % more runs, the approximation a little more.
  EXPECT_NEAR(power.smallest_effect(67), 0.354, 0.006);
  EXPECT_EQ(power.groups_needed(power.smallest_effect(67)), 67u);
  // Two sequences with half of the runs each are nearly as much.
  EXPECT_NEAR(Power(0.05, 2).smallest_effect(33), power.smallest_effect(67), 0.01);
}

TEST(PowerTable, StatesGainsAndGroups) {
  using namespace compared_sweep;  // NOLINT: its records
  std::vector<Record> records = sweep();
  const Comparison c = compared(records);
  const Table table = power_table(c, 0.05);
  EXPECT_EQ(table.lines.size(), 3u);
  EXPECT_EQ(table.lines[0][0].text, "dual");
  EXPECT_EQ(table.lines[0][1].text, "8");
  // Within each of two sequences the logarithms are 0.0136 apart on average: 0.0153.
  EXPECT_EQ(table.lines[0][2].text, "0.015");
  EXPECT_EQ(table.lines[0][3].text, "2.1 %");
  EXPECT_EQ(table.lines[2][2].text, "-");  // always twice the error: no deviation
}

TEST(PowerTable, OfIndependentRunsCountsThoseOfASequence) {
  using namespace compared_sweep;  // NOLINT: its records
  std::vector<Record> records;
  for (int run = 0; run < 20; ++run) {
    const std::string sequence = run < 10 ? "room" : "city";
    for (const std::string method : {"uniform", "dual"}) {
      const int place = (method == "dual" ? 7 : 3) * run % 10;
      const double size = method == "dual" ? 0.9 : 1.0;
      records.push_back(score(sequence, run, method, size * std::exp(0.1 * place)));
      records.back().group = recorded_group(std::to_string(run), sequence);
    }
  }
  const Table table = power_table(compared(records), 0.2);
  EXPECT_EQ(table.headings[1], "runs per sequence");
  EXPECT_EQ(table.lines[0][1].text, "10");
  // 0.0, 0.1, .. 0.9 have a deviation of 0.303, differences of two 0.428.
  EXPECT_EQ(table.lines[0][2].text, "0.428");
  EXPECT_NE(table.lines[0][3].text, "-");
  EXPECT_NE(table.lines[0][4].text, "-");
}

}  // namespace
}  // namespace loopbench::power_test
