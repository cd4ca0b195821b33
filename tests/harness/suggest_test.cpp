#include "harness/base/suggest.hpp"

#include <gtest/gtest.h>

namespace loopbench::suggest_test {

using namespace harness;

namespace {

const std::vector<std::string> kKnown{"uniform", "polyline", "cubic_spline", "dm_n4"};

TEST(Suggest, FindsASlipOfTheHand) {
  EXPECT_EQ(closest("unifrom", kKnown), "uniform");   // swapped
  EXPECT_EQ(closest("polylne", kKnown), "polyline");  // missing letter
  EXPECT_EQ(closest("dm_n5", kKnown), "dm_n4");
}

TEST(Suggest, LooksAtNothingThatIsFarTooLong) {
  EXPECT_EQ(closest("uniformly__", kKnown), "");
  EXPECT_EQ(closest(std::string(1'000'000, 'u'), kKnown), "");
}

TEST(Suggest, DoesNotGuessWildly) {
  EXPECT_EQ(closest("spaghetti", kKnown), "");
  EXPECT_EQ(unknown_name("method", "spaghetti", kKnown),
            "no method is named 'spaghetti' (known: uniform, polyline, cubic_spline, dm_n4)");
  EXPECT_EQ(unknown_name("method", "unifrom", kKnown),
            "no method is named 'unifrom'; did you mean 'uniform'?");
}

}  // namespace
}  // namespace loopbench::suggest_test
