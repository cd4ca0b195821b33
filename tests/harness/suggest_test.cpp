#include "harness/sweep/text/suggest.hpp"

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
  EXPECT_EQ(closest("ref", {"set"}), "");
  EXPECT_EQ(unknown_name("method", "spaghetti", kKnown),
            "no method is named 'spaghetti' (known: uniform, polyline, cubic_spline, dm_n4)");
  EXPECT_EQ(unknown_name("method", "unifrom", kKnown),
            "no method is named 'unifrom'; did you mean 'uniform'?");
}

TEST(Suggest, NamesTheClosestOptionOrWordOfAMessage) {
  const auto guessed = [](const std::string& option, const std::string& why) {
    return with_guess(OptionError(option, why));
  };
  EXPECT_EQ(guessed("bais", "bais: unknown option (has: seed, bias)"),
            "bais: unknown option; did you mean 'bias'? (has: seed, bias)");
  EXPECT_EQ(guessed("align", "align = simm3: expected one of se3 | sim3 | none"),
            "align = simm3: expected one of se3 | sim3 | none; did you mean 'sim3'?");
  for (const std::string why :
       {"align = 7: expected one of se3 | sim3", "bias = 2: expected 0 <= bias <= 1"}) {
    EXPECT_EQ(guessed(why.substr(0, why.find(' ')), why), why);
  }
}

}  // namespace
}  // namespace loopbench::suggest_test
