/// How many points and repeats a report draws.
#include <gtest/gtest.h>

#include "harness/report/data.hpp"

namespace loopbench::harness {
namespace {

TEST(Report, DrawsFewerPointsWhereThereAreManyCells) {
  EXPECT_EQ(points_of_a_cell(40, 5'000'000), 400u);
  EXPECT_EQ(points_of_a_cell(2000, 5'000'000), 178u);  // 5e6 / 2000 / 14
  EXPECT_EQ(points_of_a_cell(1'000'000, 5'000'000), 60u);
  EXPECT_EQ(points_of_a_cell(0, 5'000'000), 400u);
}

TEST(Thinning, TakesPointsThenRepeatsThenPoints) {
  Thinning thinning{400, 5};
  EXPECT_TRUE(reduce(thinning, 0.5));
  EXPECT_EQ(thinning.points, 200u);
  EXPECT_TRUE(reduce(thinning, 0.1));
  EXPECT_EQ(thinning.points, 60u);
  EXPECT_TRUE(reduce(thinning, 0.9));
  EXPECT_EQ(thinning.repeats, 3u);
  EXPECT_TRUE(reduce(thinning, 0.9) && reduce(thinning, 0.9));
  EXPECT_EQ(thinning.repeats, 1u);
  EXPECT_TRUE(reduce(thinning, 0.99));
  EXPECT_EQ(thinning.points, 59u);
  EXPECT_TRUE(reduce(thinning, 0.0));
  EXPECT_EQ(thinning.points, 10u);
  EXPECT_FALSE(reduce(thinning, 0.5));
}

}  // namespace
}  // namespace loopbench::harness
