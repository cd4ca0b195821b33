#include "datasets/core/pose_id.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "datasets/core/problem.hpp"

namespace loopbench::test::pose_id_test {
namespace {

TEST(PoseId, SymbolsAreLetterAndIndex) {
  constexpr std::int64_t kA12 = 6989586621679009804;  // 97 * 2^56 + 12, as GTSAM's Symbol('a', 12)
  EXPECT_EQ(id_text(kA12), "a12");
  EXPECT_EQ(id_of("a12"), kA12);
  EXPECT_EQ(id_of("6989586621679009804"), kA12);
  EXPECT_EQ(id_text((std::int64_t{'Z'} << 56) + 0), "Z0");
  Problem problem;
  problem.keyframes = {{0.0, Pose{}}};
  problem.ids = {kA12};
  EXPECT_EQ(problem.name_of(0), "a12");
}

TEST(PoseId, OthersAreNumbers) {
  for (const std::int64_t id : {std::int64_t{-3},
                                std::int64_t{0},
                                std::int64_t{12},
                                (std::int64_t{1} << 56) + 1,
                                std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(id_text(id), std::to_string(id));
    EXPECT_EQ(id_of(id_text(id)), id);
  }
  for (const char* const text : {"", "a", "12a", "a-1", "aa1", "_1", "3.5", "a99999999999999999"}) {
    EXPECT_FALSE(id_of(text)) << text;
  }
}

}  // namespace
}  // namespace loopbench::test::pose_id_test
