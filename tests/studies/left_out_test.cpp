#include "tests/studies/left_out.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace loopbench {
namespace {

// Setting 0 is best for a and b together, 1 for b and c, 0 for a and c.
const std::vector<GroupRatios> kGroups{
    {"a", "a", {{std::log(0.5), std::log(0.9)}, {std::log(0.5), std::log(0.9)}}},
    {"b", "b", {{std::log(1.0), std::log(0.8)}}},
    {"c", "c", {{std::log(1.2), std::log(1.1)}, {std::log(1.2), std::log(1.0)}}}};

TEST(LeftOut, ChoosesWithoutTheGroupItIsTestedOn) {
  EXPECT_NEAR(mean_log(kGroups[2], 1), 0.5 * std::log(1.1), 1e-15);
  const LeftOutEstimate found = left_out(kGroups);
  EXPECT_EQ(found.chosen, (std::vector<std::size_t>{1, 0, 0}));
  EXPECT_NEAR(found.ratio, std::cbrt(0.9 * 1.0 * 1.2), 1e-12);
  EXPECT_NEAR(found.worst, 1.2, 1e-12);
  EXPECT_EQ(found.above, 2u);
  EXPECT_LT(found.low, found.ratio);
  EXPECT_GT(found.high, found.ratio);
  EXPECT_GE(found.low, 0.9 - 1e-12);
  EXPECT_LE(found.high, 1.2 + 1e-12);
}

TEST(LeftOut, GroupsOfOnePartGoTogether) {
  std::vector<GroupRatios> groups = kGroups;
  groups[1].part = "a";  // then c alone selects for a and b, and a and b for c
  EXPECT_EQ(left_out(groups).chosen, (std::vector<std::size_t>{1, 1, 0}));
}

}  // namespace
}  // namespace loopbench
